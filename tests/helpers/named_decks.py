"""Decks that name boundaries, read back: MOOSE's blocks, and Code_Aster's commands and mesh."""

import ast

import numpy as np

COMMANDS = [
    "DEBUT", "LIRE_MAILLAGE", "MODI_MAILLAGE", "AFFE_MODELE", "DEFI_MATERIAU",
    "AFFE_MATERIAU", "DEFI_FONCTION", "DEFI_LIST_REEL", "FORMULE",
    "AFFE_CHAR_MECA_F", "AFFE_CHAR_MECA", "DEFI_CONTACT",
    "STAT_NON_LINE", "CREA_TABLE", "FIN",
]  # fmt: skip


def moose_blocks(text):
    """Nested blocks of an input file; every block is closed, no key stands twice, and every value with blanks is
    quoted."""
    root = {}
    open_blocks = [root]
    for line in text.splitlines():
        line = line.partition("#")[0].strip()
        if not line:
            continue
        inner = open_blocks[-1]
        if line == "[]":
            open_blocks.pop()
            assert open_blocks, "a block is closed that was not opened"
        elif line.startswith("["):
            assert line.endswith("]")
            assert line[1:-1] not in inner
            inner[line[1:-1]] = {}
            open_blocks.append(inner[line[1:-1]])
        else:
            key, _, value = line.partition(" = ")
            assert key not in inner
            quoted = value.startswith("'")
            assert value.endswith("'") == quoted
            assert quoted == (" " in value), line
            inner[key] = value.strip("'")
    assert open_blocks == [root], "a block is not closed"
    return root


class Concept:
    """What a command of Code_Aster makes: its name, and what it was given."""

    def __init__(self, command, **given):
        self.command, self.given = command, given


class Table(Concept):
    """A table: columns by name."""

    columns = staticmethod(lambda given: {key: [] for key in ("COOR_X", *given["NOM_CMP"])})

    def EXTR_TABLE(self):
        return self

    def values(self):
        return self.columns(self.given["RESU"])


def aster_concepts(text):
    """Names of a command file after it was run with commands that do nothing."""
    ast.parse(text)
    names = {"_F": dict} | {
        name: lambda _name=name, **given: (Table if _name == "CREA_TABLE" else Concept)(_name, **given)
        for name in COMMANDS
    }
    exec(compile(text, "deck.comm", "exec"), names)
    return names


class Mail:
    """Mesh file of Code_Aster: ``nodes`` by name, ``cells`` by name, and groups of both."""

    def __init__(self, text):
        lines = text.splitlines()
        assert max(map(len, lines)) <= 80
        assert lines[-1] == "FIN"
        self.nodes, self.cells, self.kinds, self.of_cells, self.of_nodes = {}, {}, {}, {}, {}
        block = None
        for line in lines[:-1]:
            words = line.split()
            if line == "FINSF":
                block = None
            elif block is None:
                block = words[0]
                if block.startswith("GROUP"):
                    groups = self.of_cells if block == "GROUP_MA" else self.of_nodes
                    name = words[1].removeprefix("NOM=")
                    assert name not in groups
                    members = groups[name] = []
            elif block == "COOR_2D":
                self.nodes[words[0]] = np.array(words[1:], dtype=float)
            elif block in ("QUAD4", "SEG2"):
                assert words[0] not in self.cells
                self.cells[words[0]], self.kinds[words[0]] = words[1:], block
            else:
                members += words
        assert all(set(names) <= self.nodes.keys() for names in self.cells.values())

    def edges(self, group):
        """Vectors along the edges of a group."""
        return np.array([self.nodes[b] - self.nodes[a] for a, b in map(self.cells.get, self.of_cells[group])])
