"""Input decks of Abaqus and CalculiX: what meshio reads as another mesh, or leaves out in silence, is refused."""

import itertools
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

_STAR = re.compile(rb"^\*", re.MULTILINE)  # a keyword or a comment, at which meshio ends what stands above
_NUMBERED = re.compile(rb"^[ \t]*(\d+)[ \t]*,", re.MULTILINE)
# fixed: keywords that make or move nodes and elements; meshio skips them
_SKIPPED = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "TRANSLATE", "SUBMODEL"}
_LISTS = {"NODE", "ELEMENT", "NSET", "ELSET"}


class _Card(NamedTuple):
    """A keyword, its parameters in capitals, and the lines below it."""

    keyword: str
    parameters: dict[str, str]
    lines: bytes


def fault(decks: Iterable[bytes], names: Sequence[str]) -> str:
    """Return what is wrong with the ``decks``, a file and those that it includes; empty if nothing is.

    Parameters
    ----------
    decks : iterable of bytes
    names : sequence of str
        Groups that are looked for, in lower case.
    """
    cards = [_card(text) for deck in decks for text in _STAR.split(deck.replace(b"\r\n", b"\n"))[1:]]
    for before, comment in itertools.pairwise(cards):
        if comment.keyword.startswith("*") and comment.lines.strip() and before.keyword in _LISTS:
            return f"must have no comment between the lines of *{before.keyword}: what follows it is not read"
    if skipped := next((card.keyword for card in cards if card.keyword in _SKIPPED), None):
        return f"must list all nodes and elements where they are; *{skipped} is not read"
    for card in cards:
        if card.keyword in ("NODE", "ELEMENT") and (elsewhere := {"INPUT", "SYSTEM"} & card.parameters.keys()):
            return f"must list nodes and elements by their coordinates and nodes; {elsewhere.pop()} is not read"
        if card.keyword == "INSTANCE" and card.lines.strip():
            return "must have the part where it is in the assembly; the shift of *INSTANCE is not read"
    nodes = [card for card in cards if card.keyword == "NODE"]
    if len(nodes) > 1:
        only = "join the blocks, and leave out reference nodes and other bodies"
        return f"must have one block *NODE, with the nodes of one body, not {len(nodes)}: {only}"
    for card in nodes:
        numbers = np.array(_NUMBERED.findall(card.lines), dtype="S20")
        if twice := len(numbers) - len(np.unique(numbers)):
            return f"must have each node once; {twice} are there again"
    return _fault_of_sets(cards, names)


def _fault_of_sets(cards: Sequence[_Card], names: Sequence[str]) -> str:
    """What is wrong with the sets of these ``names``: meshio keeps the last one of a name, and takes the first sets of
    elements for those of the first blocks of elements."""
    sets = [
        (kind, card.parameters[kind].lower())
        for card in cards
        for kind in ("NSET", "ELSET")
        if kind in card.parameters and card.keyword in ("NSET", "ELSET", "NODE", "ELEMENT")
    ]
    for (kind, name), times in Counter(sets).items():
        if not name:
            return f"must have the name of each set; a parameter {kind} has none"
        if times > 1 and name in names:
            return f"must have the set {name!r} once; {times} *{kind} have this name"
    blocks = [card.parameters.get("ELSET", "").lower() for card in cards if card.keyword == "ELEMENT"]
    for number, name in enumerate(blocks):
        if name in names and not all(blocks[:number]):
            return f"must have the set {name!r} as *ELSET after the elements, or ELSET in all blocks *ELEMENT before it"
    return ""


def _card(text: bytes) -> _Card:
    head, _, lines = text.partition(b"\n")
    keyword, *parameters = head.decode("latin-1").split(",")
    pairs = (each.partition("=") for each in parameters if each.strip())
    return _Card(keyword.strip().upper(), {key.strip().upper(): value.strip() for key, _, value in pairs}, lines)
