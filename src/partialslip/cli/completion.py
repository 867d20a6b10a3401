"""partialslip completion: shell completion of commands, options, scenes and files."""

import argparse
import sys
from collections.abc import Iterator

import partialslip
from partialslip.cli.common import Commands

_SHELLS = ("bash", "zsh")
_SCENES = {"bash": "_partialslip_scenes", "zsh": "_partialslip_scenes"}
_FUNCTIONS = {
    "bash": """\
_partialslip_scenes() {{
  compgen -W "{names}" -- "$1"
  compgen -f -X '!*.toml' -- "$1"
  compgen -d -S / -- "$1"
}}
""",
    "zsh": """\
_partialslip_scenes() {{
  _alternative 'scenes:shipped scene:({names})' 'files:scene file:_files -g "*.toml"'
}}
""",
}


def add(commands: Commands, root: argparse.ArgumentParser) -> None:
    """Add the command to ``commands``; it completes the commands and options of ``root``."""
    completion = commands.add_parser(
        "completion",
        help="print a completion script for bash or zsh",
        description="Print a script for shell completion of commands, options, names of scenes and files.",
        examples=[
            'eval "$(partialslip completion bash)"',
            "partialslip completion bash > ~/.local/share/bash-completion/completions/partialslip",
            'partialslip completion zsh > "${fpath[1]}/_partialslip"',
        ],
    )
    completion.add_argument("shell", metavar="SHELL", choices=_SHELLS, help="bash or zsh")
    completion.set_defaults(command=lambda options: _completion(root, options.shell))


def _completion(root: argparse.ArgumentParser, shell: str) -> int:
    import shtab

    files = {"SCENE": _SCENES, "FILE": shtab.FILE, "DIR": shtab.DIRECTORY}
    for action in _actions(root):
        if action.metavar in files:
            action.complete = files[action.metavar]  # type: ignore[attr-defined]
    preamble = _FUNCTIONS[shell].format(names=" ".join(partialslip.shipped_scenes()))
    sys.stdout.write(shtab.complete(root, shell, preamble=preamble))
    return 0


def _actions(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    """Yield all arguments of ``parser`` and of its subcommands."""
    for action in parser._actions:
        yield action
        if isinstance(action, argparse._SubParsersAction):
            for below in action.choices.values():
                yield from _actions(below)
