"""Input decks, read back."""

import numpy as np

UNIT = 1e-6  # of length in CalculiX's deck, a = 1 mm
COARSE = {"size": 0.5, "growth": 1.0}


class Deck:
    """Keyword blocks of an input deck, in order: the keyword with its parameters, and its lines of fields."""

    def __init__(self, path):
        self.blocks = []
        for line in path.read_text("ascii").splitlines():
            if line.startswith("**"):
                continue
            assert all(len(word) <= 20 for word in line.split(",") if not line.startswith("*"))
            if line.startswith("*"):
                self.blocks.append((line, []))
            else:
                self.blocks[-1][1].append([word.strip() for word in line.split(",")])

    def rows(self, start):
        return [row for keyword, rows in self.blocks if keyword.startswith(start) for row in rows]

    def table(self, start, kind=float):
        return np.array(self.rows(start), dtype=kind)

    def members(self, name):
        return np.concatenate([np.array(row, dtype=int) for row in self.rows(f"*NSET, NSET={name}")])

    def steps(self):
        """Of each step the last displacements and forces put on nodes, by (node, component)."""
        steps = []
        for keyword, rows in self.blocks:
            if keyword.startswith("*STEP"):
                steps.append(({}, {}))
            elif keyword.startswith("*BOUNDARY"):
                put = [row for row in rows if row[0].isdigit()]
                steps[-1][0].update({(int(row[0]), int(row[1])): float((*row, "0")[3]) for row in put})
            elif keyword.startswith("*CLOAD"):
                steps[-1][1].update({(int(row[0]), int(row[1])): float(row[2]) for row in rows})
        return steps


def places(deck):
    nodes = deck.table("*NODE, NSET=")
    result = np.full((int(nodes[:, 0].max()) + 1, nodes.shape[1] - 1), np.nan)
    result[nodes[:, 0].astype(int)] = nodes[:, 1:]
    return result


def deck_equations(deck):
    """Blocks of equations."""
    return [block for block in deck.blocks if block[0] == "*EQUATION"]
