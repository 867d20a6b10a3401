"""Write paper.md from paper.in.md: python paper/paper.py [--numbers]. Every number comes from frozen files: the targets
of the edition, the answers in benchmarks/submissions, and docs/gallery.md. --numbers prints them."""

import re
import sys
import textwrap
from collections.abc import Iterable, Iterator
from pathlib import Path
from statistics import median

from partialslip.scene.reading import load_scene
from partialslip.verify.benchmark.folder import examined
from partialslip.verify.benchmark.gold import GROUPS
from partialslip.verify.benchmark.problem import EDITION, read_problems
from partialslip.verify.benchmark.submission import Submission

HERE = Path(__file__).parent
ROOT = HERE.parent
EXACT = 1e-9  # fixed: uncertainty of a target of the exact method, in its scale
PROBLEMS = read_problems()


def main() -> None:
    """Write the paper, or print its numbers."""
    if "--numbers" in sys.argv[1:]:
        for name, text in numbers().items():
            print(f"{name:16} {text}")
    else:
        (HERE / "paper.md").write_text(paper(), "utf-8")


def paper() -> str:
    """The paper, with its numbers."""
    head, body = (HERE / "paper.in.md").read_text("utf-8").split("\n\n", 1)
    parts = body.format(**numbers()).strip().split("\n\n")
    filled = [textwrap.fill(part, 120, break_long_words=False, break_on_hyphens=False) for part in parts]
    return "\n\n".join([head, *filled]) + "\n"


def numbers() -> dict[str, str]:
    """Texts of the numbers by name."""
    targets = [target for problem in PROBLEMS.values() for target in problem.targets.values()]
    main_targets = [target.uncertainty for target in targets if target.group in GROUPS]
    sure = [
        number
        for number, problem in PROBLEMS.items()
        if all(target.uncertainty <= EXACT for target in problem.targets.values() if target.group in GROUPS)
    ]
    answers = [_answers(folder) for folder in sorted((ROOT / "benchmarks" / "submissions").iterdir())]
    own = {each.meta.code.removeprefix("partialslip "): each for each in answers}
    others = [each for each in answers if not each.meta.code.startswith("partialslip")]
    contact, stick = ([median(_errors(each, keys, PROBLEMS)) for each in others] for keys in (("a",), ("m", "n")))
    times = [zone / width for zone, width in zip(stick, contact, strict=True)]
    widths = [
        (each["m"].value + each["n"].value) / each["a"].value
        for problem in PROBLEMS.values()
        if "m" in (each := problem.targets) and each["m"].value + each["n"].value > 0
    ]
    lower = load_scene(ROOT / "docs" / "scenes" / "fretting-rig.toml").bodies.lower
    assert lower is not None
    assert lower.height is not None
    return {
        "edition": EDITION,
        "problems": str(len(PROBLEMS)),
        "targets": str(len(targets)),
        "exact": str(sum(target.uncertainty <= EXACT for target in targets)),
        "exact_to": _short(EXACT),
        "exact_problems": str(len(sure)),
        "main_unsure": _short(max(main_targets)),
        "unsure": _short(max(target.uncertainty for target in targets)),
        "columns": str(len(others)),
        "codes": ", ".join(f"{each.meta.code} {each.meta.version}" for each in others),
        "contact_low": _short(min(contact)),
        "contact_high": _short(max(contact)),
        "stick_low": _short(min(stick)),
        "stick_high": _short(max(stick)),
        "harder_low": f"{min(times):.1f}",
        "harder_high": f"{max(times):.0f}",
        "fem_stick": _short(max(_errors(own["fem-1e-5"], ("m", "n"), sure))),
        "march_stick": _short(max(_errors(own["march"], ("m", "n"), sure))),
        "narrowest": _short(min(widths)),
        "finite": str(sum(problem.scene.finite for problem in PROBLEMS.values())),
        "thick": f"{2e3 * lower.height:g}",
        **_rig(),
    }


def _answers(folder: Path) -> Submission:
    return examined(folder, PROBLEMS, with_tables=False).as_written()


def _errors(answers: Submission, keys: Iterable[str], numbers: Iterable[str]) -> Iterator[float]:
    """Errors of the values with these ``keys``, in a, in the problems with these ``numbers``."""
    for number in numbers:
        given = answers.answers[number].values if number in answers.answers else {}
        for key in keys:
            if (value := given.get(key)) is not None:
                target = PROBLEMS[number].targets[key]
                yield abs(value - target.value) / target.scale


def _rig() -> dict[str, str]:
    """What the size of the bodies changes of the published case, from the gallery."""
    page = " ".join((ROOT / "docs" / "gallery.md").read_text("utf-8").split())
    found = re.search(r"bodies moves m by -(\S+) a and n by \+(\S+) a, and the .*? MPa \(\+([\d.]+)%\)", page)
    assert found
    m, n, rise = found.groups()
    return {"rig_m": m if m == n else f"{m} and {n}", "rig_rise": f"{rise} %"}


def _short(value: float) -> str:
    return re.sub("e-0", "e-", f"{value:.1e}").replace(".0e", "e")


if __name__ == "__main__":
    main()
