"""Run a verification: solve the cases of a suite in parallel, keep a ledger, judge, and write the report."""

import dataclasses
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from msgspec.structs import replace

from partialslip.report.figure import traction_svg
from partialslip.report.files import PDF, tractions_csv, write_page
from partialslip.report.rows import Sheet, sheet
from partialslip.report.sketch import sketch_svg
from partialslip.result import Result
from partialslip.run import compared
from partialslip.run.judge import Conclusion, Outcome
from partialslip.scene.plan import plan
from partialslip.scene.reading import scene_toml
from partialslip.study.batch.ledger import Ledger, case_key, scene_content
from partialslip.study.batch.sweep import SweepProgress, Task, work_through, workers
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import read_text
from partialslip.tools.methods import REFERENCES
from partialslip.tools.output.files import write_texts
from partialslip.tools.output.page import check_pdf
from partialslip.tools.output.place import Request, placed
from partialslip.verify.case import Case, CaseVerdict, Found, judge_case, solve_case, whole
from partialslip.verify.document import Account, Study, document, read_study
from partialslip.verify.entry import Entry, Settings, TitleBlock
from partialslip.verify.formulas import formulas
from partialslip.verify.ladder import SIZES, climb, has_ladder
from partialslip.verify.suites import SUITES, Maker, Makers, Suite, stress_suite, suite
from partialslip.verify.verdicts import was_finished, write_verdicts

_SCENES, _FIGURE, _SKETCH = "scenes", "tractions.svg", "sketch.svg"
# The ledger, and that of a run that begins anew where another one has finished.
_LEDGER, _NEXT = "ledger.jsonl", ".ledger.jsonl"
_MOST = 999_999_999  # limit: largest seed
_LARGEST = 10**8  # limit: bytes of a figure


@dataclass(frozen=True)
class Verification:
    """Outcome of the verification of a suite.

    Parameters
    ----------
    verdicts : dict of str to list of CaseVerdict
        Verdicts by case.
    files : list of Path
        Files written.
    again : tuple of str
        Cases solved again, because scene, settings or source files had changed since an earlier, stopped run.
    elsewhere : str
        Why the files are not in the usual folder; empty if they are.
    """

    verdicts: dict[str, list[CaseVerdict]]
    files: list[Path]
    again: tuple[str, ...] = ()
    elsewhere: str = ""

    @property
    def conclusion(self) -> Conclusion:
        """What the verdicts amount to (:func:`partialslip.verify.case.whole`)."""
        return whole(verdict for some in self.verdicts.values() for verdict in some)

    @property
    def outcome(self) -> Outcome:
        """Overall outcome."""
        return self.conclusion.outcome

    @property
    def passed(self) -> bool:
        """Whether every headline quantity of every case was judged and nothing is missed."""
        return self.outcome is Outcome.PASSED


def verify_suite(
    name: Suite = "quick",
    only: Sequence[str] = (),
    *,
    method: str | None = None,
    seed: int | None = None,
    count: int | None = None,
    processes: int | None = None,
    out: str | Path | None = None,
    force: bool = False,
    include: Sequence[str | Path] = (),
    ladder: bool = False,
    pdf: bool = False,
    block: TitleBlock = TitleBlock(),  # noqa: B008 - immutable
    progress: SweepProgress = lambda *_: None,
) -> Verification:
    """Solve and judge the cases of a suite, and write verdicts and report.

    A stopped run continues. Cases whose scene, settings or source files have changed are solved again. A finished run
    starts anew; its ledger, verdicts and report stay until the new ones are there.

    Parameters
    ----------
    name : str
        "quick": shipped scenes; "full": shipped scenes and hard cases; "book": problems of the benchmark; "stress":
        random scenes.
    only : sequence of str
        Names of cases, with wildcards * and ?; numbers of random scenes. Default: all cases.
    method, seed, count : optional
        For random scenes only: method (default "exact"), seed (0) and number of scenes (100).
    processes : int, optional
        Number of parallel processes (default: number of cores). With more than one, a script must call this function
        under ``if __name__ == "__main__":``, because each process imports the script.
    out : str or Path, optional
        Folder for ``ledger.jsonl``, ``results.json``, ``results.csv``, ``report.html`` and ``scenes`` (``scene.toml``,
        ``tractions.csv``, ``tractions.svg`` and ``sketch.svg`` of each scene, except random ones). Default:
        ``results/verify-SUITE``, with other settings than the default ones ``results/verify-SUITE-HASH``.
    force : bool
        Whether to write into a folder that holds another verification or other results.
    include : sequence of str or Path
        Folders of studies (``partialslip study``); their figures are put into the report.
    ladder : bool
        Whether to add a refinement ladder (:mod:`partialslip.verify.ladder`) to each case that allows one.
    pdf : bool
        Whether to write the report as ``report.pdf``, too.
    block : TitleBlock
        Project, author, reviewer and document number for the report.
    progress : callable
        ``progress(done, total, seconds_left)``.

    Raises
    ------
    InputError
        If a suite, case, method or study does not exist, if the folder cannot be written or ``out`` holds other
        results, or if another process writes to the folder.
    MissingLibraryError
        If a library for the PDF is missing.
    """
    if processes is not None and processes < 1:
        raise InputError(f"--processes {processes}: must be >= 1")
    if pdf:
        check_pdf(PDF)  # before anything is solved
    settings, makers, keys = _cases(name, only, method, seed, count, ladder)
    settings = replace(settings, block=block)
    studies = [read_study(Path(each)) for each in include]
    request = Request(_request(settings), _request(_settings(name)))
    with placed(Path("results") / f"verify-{name}", out, request, force) as place:
        done = _verify(settings, makers, keys, studies, place.path, processes, pdf, progress)
    return dataclasses.replace(done, elsewhere=place.elsewhere)


def _verify(
    settings: Settings,
    makers: Makers,
    keys: Mapping[str, str],
    studies: Sequence[Study],
    folder: Path,
    processes: int | None,
    pdf: bool,
    progress: SweepProgress,
) -> Verification:
    anew = was_finished(folder)
    ledger = Ledger(folder / (_NEXT if anew else _LEDGER))
    if not anew:
        write_verdicts(folder, settings, {}, finished=False)
    finished = {str(entry.get("case")) for entry in ledger}
    again = tuple(case for case, key in keys.items() if case in finished and key not in ledger)
    scenes = None if settings.suite == "stress" else folder / _SCENES
    work = partial(solve_and_judge, folder=scenes, ladder=settings.ladder)
    tasks = [Task(keys[case], work, make) for case, make in makers.items()]
    try:
        with workers(processes=min(processes or os.cpu_count() or 1, len(tasks))) as executor:
            work_through(tasks, ledger, executor, progress)
        entries = {case: ledger.read(key, Entry) for case, key in keys.items()}
        figures, sketches = (_figures(folder / _SCENES, entries, name) for name in (_FIGURE, _SKETCH))
        page = document(Account(settings, entries, figures, sketches, studies))
        files = write_page(page, folder, pdf=pdf)
        verdicts = _verdicts(ledger, keys)
        if anew:
            _replace(folder, pdf)
    except BaseException:
        if not anew:
            write_verdicts(folder, settings, _verdicts(ledger, keys), finished=False)
        raise
    files = [folder / _LEDGER, *write_verdicts(folder, settings, verdicts, finished=True), *files]
    return Verification(verdicts, files, again)


def solve_and_judge(make: Maker, folder: Path | None, ladder: bool = False) -> Entry:
    """Make, solve and judge a case. Returns the entry for a ledger.

    Parameters
    ----------
    make : callable
        ``make() -> Case``.
    folder : Path or None
        Folder for the scene, the tractions and their figure, in a subfolder with the name of the case. None: no files,
        and no sheet for the report.
    ladder : bool
        Whether to add a refinement ladder, if the case allows one.
    """
    case = make()
    found = solve_case(case)
    exact = found.get("exact")
    return Entry(
        case=case.name,
        hard=case.hard,
        verdicts=tuple(verdict.finite for verdict in judge_case(case, found)),
        sheet=_file(case, found, folder / case.name) if folder else None,
        own_meshes=case.meshes is not None,
        formulas=formulas(case.scene, exact) if isinstance(exact, Result) else (),
        ladder=climb(case.scene, exact) if ladder and isinstance(exact, Result) and has_ladder(case) else (),
    )


def _file(case: Case, found: Found, folder: Path) -> Sheet | None:
    results = {method: result for method, result in found.items() if isinstance(result, Result)}
    texts, shown = {"scene.toml": scene_toml(case.scene), _SKETCH: sketch_svg(case.scene)}, None
    if results:
        run = compared(case.scene, plan(case.scene), results, None)
        texts |= {"tractions.csv": tractions_csv(run), _FIGURE: traction_svg(run)}
        shown = sheet(run)
    write_texts(folder, texts)
    return shown


def _cases(
    name: Suite, only: Sequence[str], method: str | None, seed: int | None, count: int | None, ladder: bool
) -> tuple[Settings, Makers, dict[str, str]]:
    """Return the settings, the functions that make the cases, and the ledger's keys, by case."""
    settings = _settings(name, only, method, seed, count, ladder)
    if settings.method is None or settings.seed is None or settings.count is None:
        makers, extra = suite(name, only), {"ladder": list(SIZES)} if ladder else {}
        return settings, makers, {case: case_key(_content(make()) | extra) for case, make in makers.items()}
    makers = stress_suite(settings.method, settings.seed, settings.count, only)
    # the name holds seed and number, which determine a random scene
    return settings, makers, {case: case_key({"method": settings.method, "case": case}) for case in makers}


def _settings(
    name: Suite,
    only: Sequence[str] = (),
    method: str | None = None,
    seed: int | None = None,
    count: int | None = None,
    ladder: bool = False,
) -> Settings:
    """Return the settings of a verification, with the defaults of the suite."""
    if name not in SUITES:
        raise InputError(f"--suite {name!r}: must be one of {', '.join(SUITES)}")
    settings = Settings(suite=name, only=tuple(only), ladder=ladder)
    if name != "stress":
        for key, value in {"method": method, "seed": seed, "count": count}.items():
            if value is not None:
                raise InputError(f"--{key} {value}: only with --suite stress")
        return settings
    if ladder:
        raise InputError("--ladder: not with --suite stress: random scenes have no exact solution on each mesh")
    method = "exact" if method is None else method
    if method not in REFERENCES:
        raise InputError(f"--method {method!r}: must be one of {', '.join(REFERENCES)}")
    seed, count = _within("seed", seed, 0, 0), _within("count", count, 100, 1)
    return replace(settings, method=method, seed=seed, count=count)


def _request(settings: Settings) -> dict[str, Any]:
    """Return what a verification is asked for as plain data (:class:`partialslip.tools.output.place.Request`)."""
    return {"command": "verify", "settings": {**settings.asked, "only": settings.only, "ladder": settings.ladder}}


def _content(case: Case) -> dict[str, Any]:
    """Return a case as plain data for the ledger's key."""
    meshes = [case.meshes.func, case.meshes.keywords] if isinstance(case.meshes, partial) else [case.meshes]
    own = {
        "methods": list(case.methods),
        "bars": dict(case.bars),
        "reference": case.reference,
        "meshes": list(map(_named, meshes)),
    }
    return {"scene": scene_content(case.scene), **own}


def _named(part: Any) -> Any:
    """Return the name of a function; other objects as they are."""
    return getattr(part, "__qualname__", part)


def _within(key: str, value: int | None, usual: int, least: int) -> int:
    number = usual if value is None else value
    if not least <= number <= _MOST:
        raise InputError(f"--{key} {number}: must be a whole number from {least} to {_MOST}")
    return number


def _replace(folder: Path, pdf: bool) -> None:
    """Let the ledger of a run that began anew take the place of that of the finished one, whose report as PDF goes if
    the new one has no ``pdf``."""
    try:
        (folder / _NEXT).replace(folder / _LEDGER)
        if not pdf:
            (folder / PDF).unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"{folder / _LEDGER}: cannot be replaced: {error.strerror}") from None


def _verdicts(ledger: Ledger, keys: Mapping[str, str]) -> dict[str, list[CaseVerdict]]:
    """Return the verdicts in the ledger by case, in the order of ``keys``."""
    return {case: list(ledger.read(key, Entry).verdicts) for case, key in keys.items() if key in ledger}


def _figures(folder: Path, entries: Mapping[str, Entry], name: str) -> dict[str, str]:
    """Return the figures in the files ``name`` by case, of cases with a sheet."""
    paths = {case: folder / case / name for case, entry in entries.items() if entry.sheet}
    try:
        return {case: read_text(path, _LARGEST) for case, path in paths.items()}
    except InputError:
        raise InputError(f"{folder}: figures of finished cases are missing; remove ledger.jsonl to restart") from None
