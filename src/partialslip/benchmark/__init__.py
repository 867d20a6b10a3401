"""Numbered problems with frozen targets, for other codes to measure themselves by."""

from partialslip.benchmark.badge import badge as badge
from partialslip.benchmark.badge import badge_names as badge_names
from partialslip.benchmark.book import book_page as book_page
from partialslip.benchmark.book import book_zip as book_zip
from partialslip.benchmark.folder import read_submission as read_submission
from partialslip.benchmark.grade import Graded as Graded
from partialslip.benchmark.grade import Mark as Mark
from partialslip.benchmark.grade import graded as graded
from partialslip.benchmark.handin import handed_in as handed_in
from partialslip.benchmark.ladder import CLIMB_HEADS as CLIMB_HEADS
from partialslip.benchmark.ladder import Climb as Climb
from partialslip.benchmark.ladder import climb_rows as climb_rows
from partialslip.benchmark.ladder import climbs as climbs
from partialslip.benchmark.problem import Problem as Problem
from partialslip.benchmark.problem import Source as Source
from partialslip.benchmark.problem import Target as Target
from partialslip.benchmark.problem import read_problems as read_problems
from partialslip.benchmark.scoreboard import Board as Board
from partialslip.benchmark.scoreboard import Standing as Standing
from partialslip.benchmark.scoreboard import scoreboard as scoreboard
from partialslip.benchmark.scoreboard import standing as standing
from partialslip.benchmark.submission import Answer as Answer
from partialslip.benchmark.submission import Meta as Meta
from partialslip.benchmark.submission import Rung as Rung
from partialslip.benchmark.submission import Submission as Submission
from partialslip.benchmark.submission import write_submission as write_submission

__all__ = [
    "CLIMB_HEADS",
    "Answer",
    "Board",
    "Climb",
    "Graded",
    "Mark",
    "Meta",
    "Problem",
    "Rung",
    "Source",
    "Standing",
    "Submission",
    "Target",
    "badge",
    "badge_names",
    "book_page",
    "book_zip",
    "climb_rows",
    "climbs",
    "graded",
    "handed_in",
    "read_problems",
    "read_submission",
    "scoreboard",
    "standing",
    "write_submission",
]
