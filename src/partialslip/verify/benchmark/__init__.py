"""Numbered problems with frozen targets, for other codes to measure themselves by."""

from typing import TYPE_CHECKING

from partialslip.tools.lazy import homes_of, make_lazy

if TYPE_CHECKING:
    from partialslip.verify.benchmark.book import book_page as book_page
    from partialslip.verify.benchmark.book import book_zip as book_zip
    from partialslip.verify.benchmark.folder import read_submission as read_submission
    from partialslip.verify.benchmark.grade import Graded as Graded
    from partialslip.verify.benchmark.grade import Mark as Mark
    from partialslip.verify.benchmark.grade import graded as graded
    from partialslip.verify.benchmark.handin import handed_in as handed_in
    from partialslip.verify.benchmark.ladder import CLIMB_HEADS as CLIMB_HEADS
    from partialslip.verify.benchmark.ladder import Climb as Climb
    from partialslip.verify.benchmark.ladder import climb_rows as climb_rows
    from partialslip.verify.benchmark.ladder import climbs as climbs
    from partialslip.verify.benchmark.problem import Problem as Problem
    from partialslip.verify.benchmark.problem import Source as Source
    from partialslip.verify.benchmark.problem import Target as Target
    from partialslip.verify.benchmark.problem import read_problems as read_problems
    from partialslip.verify.benchmark.scoreboard import Board as Board
    from partialslip.verify.benchmark.scoreboard import Standing as Standing
    from partialslip.verify.benchmark.scoreboard import badge as badge
    from partialslip.verify.benchmark.scoreboard import badge_names as badge_names
    from partialslip.verify.benchmark.scoreboard import scoreboard as scoreboard
    from partialslip.verify.benchmark.scoreboard import standing as standing
    from partialslip.verify.benchmark.statements import Statement as Statement
    from partialslip.verify.benchmark.statements import read_statements as read_statements
    from partialslip.verify.benchmark.submission import Answer as Answer
    from partialslip.verify.benchmark.submission import Meta as Meta
    from partialslip.verify.benchmark.submission import Rung as Rung
    from partialslip.verify.benchmark.submission import Submission as Submission
    from partialslip.verify.benchmark.submission import write_submission as write_submission

_HOMES = homes_of(
    {
        "book": "book_page book_zip",
        "folder": "read_submission",
        "grade": "Graded Mark graded",
        "handin": "handed_in",
        "ladder": "CLIMB_HEADS Climb climb_rows climbs",
        "problem": "Problem Source Target read_problems",
        "scoreboard": "Board Standing badge badge_names scoreboard standing",
        "statements": "Statement read_statements",
        "submission": "Answer Meta Rung Submission write_submission",
    }
)
__all__ = [*_HOMES]
make_lazy(__name__, _HOMES)
