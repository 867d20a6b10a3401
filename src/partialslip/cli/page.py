"""partialslip page: a live page with sliders for loads and friction."""

import argparse
from pathlib import Path

import partialslip
from partialslip.cli.common import Commands, add_out, add_scene, check_output
from partialslip.cli.findings import Findings, present

_SCENE = "fretting-aluminium"


def add(commands: Commands) -> None:
    """Add the command to the parser of ``commands``."""
    page = commands.add_parser(
        "page",
        help="make a live page: sliders for loads and friction",
        description="Make one HTML file with sliders for the loads and the friction. The page shows tractions, stick "
        "zone and the point on the stick-zone map. P is constant. The "
        "page calculates in the browser, without network. Finite bodies are left out.",
        examples=["partialslip page", "partialslip page hertz-large-tension --out live"],
    )
    told = "a shipped scene or a TOML file, with a Hertz profile; the sliders start at the scene's loads"
    add_scene(page, f"{told} (default: {_SCENE})", optional=True, usual=_SCENE)
    add_out(page, "results/NAME-page[-HASH]", what="folder for page.html")
    page.set_defaults(command=_page)


def _page(options: argparse.Namespace) -> int:
    check_output(options)
    scene = partialslip.load_scene(options.scene, options.overrides)

    from partialslip.study.live import live_page
    from partialslip.study.map.files import bodies_left_out
    from partialslip.tools.output.files import write_texts

    text, lines = live_page(scene), bodies_left_out(scene, "the page")

    def find(folder: Path) -> Findings:
        return Findings(write_texts(folder, {"page.html": text}), printed=lines)

    return present(options, "page", f"{scene.name}-page", scene, find)
