"""How large must a block be to count as a half-plane? Four sizes, kept in a ledger: run it again, and nothing is solved
twice.

python examples/size_of_a_body.py [FOLDER]
"""

import sys
from pathlib import Path

import partialslip
from partialslip.study.batch.ledger import Ledger
from partialslip.study.batch.sweep import workers
from partialslip.study.size import sizes
from partialslip.study.size.axes import axis

scene = partialslip.load_scene(
    "hertz-shear",
    [
        "fem.accuracy=1e-3",
        "bodies.lower={kind='block',width=0.05,height=0.05,support='clamped'}",
        "bodies.upper={kind='block',width=0.05,height=0.05,support='clamped'}",
    ],
)
folder = Path(sys.argv[1] if len(sys.argv) > 1 else "size_of_a_body")
over = axis("bodies.*.width+bodies.*.height=8a..64a:4")

if __name__ == "__main__":  # worker processes import this file
    ledger = Ledger(folder / "ledger.jsonl")
    known = len(ledger)
    with workers(processes=1) as executor:
        found = sizes.measure(scene, [over], ledger, executor, control=False)
    print(f"{len(ledger)} cases in {ledger.path}, {len(ledger) - known} of them solved now")
    for size, change in zip(sizes.along(over, found).size, sizes.along(over, found).off["a"], strict=True):
        print(f"blocks of {size:g} a: the contact half-width differs from the half-plane's by {change:.2%}")
