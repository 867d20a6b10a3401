"""Decks of Abaqus that meshio reads as another mesh in silence, or of which it leaves out a part."""

import contextlib
import re

import meshio
import numpy as np
import pytest
from refusing import line_of

from partialslip.tools.errors import InputError
from partialslip_meshes import block, deck, read

FIELD = "bodies.lower.mesh"


@pytest.fixture(scope="module")
def mesh():
    return block(4.0, (-0.3, 0.3), {}, 0.5, 2.0, along=0.05)


@pytest.fixture(scope="module")
def text(mesh, tmp_path_factory):
    """A sound deck: nodes, elements, and the groups as sets of nodes."""
    path = tmp_path_factory.mktemp("sound") / "body.inp"
    sets = {name: np.unique(edges) for name, edges in mesh.lines.items()}
    points = np.column_stack([mesh.points, 0 * mesh.points[:, 0]])
    meshio.write(path, meshio.Mesh(points, [("triangle", mesh.triangles)], point_sets=sets))
    return path.read_text()


def at(folder, content):
    path = folder / "body.inp"
    path.write_text(content)
    return str(path)


def nodes(text):
    """The lines of the block *NODE."""
    return re.search(r"\*NODE\n((?:[^*].*\n)*)", text)[1].splitlines()


def between(text, *lines, after=100):
    """The deck with more ``lines`` in the midst of its nodes."""
    split = nodes(text)[after]
    return text.replace(split, "\n".join([split, *lines]), 1)


def doubled(text, shift=0.05):
    """The deck and a second part with the same numbers, its nodes farther down."""
    moved = []
    for line in nodes(text):
        number, x, y, z = line.split(",")
        moved.append(f"{number},{x},{float(y) * (1 + shift)},{z}")
    return text + "*END PART\n*PART, NAME=INSERT\n*NODE\n" + "\n".join(moved) + "\n*END PART\n"


CASES = {
    "a second part": (doubled, "must have one block *NODE, with the nodes of one body, not 2"),
    "a reference node": (lambda text: text + "*NODE\n9001, 0, 9, 0\n", "must have one block *NODE"),
    "nodes in two blocks": (lambda text: between(text, "*NODE, NSET=REST"), "must have one block *NODE"),
    "a node twice": (lambda text: between(text, nodes(text)[3]), "must have each node once; 1 are there again"),
    "a node elsewhere": (lambda text: between(text, "7, 0.1, -0.2, 0"), "must have each node once; 1 are there again"),
    "a comment": (lambda text: between(text, "** more"), "no comment between the lines of *NODE"),
    "a comment in a set": (
        lambda text: re.sub(r"(\*NSET, NSET=contact\n.*\n)", r"\1** more\n", text),
        "no comment between the lines of *NSET",
    ),
    "made nodes": (lambda text: text.replace("*ELEMENT", "*NGEN\n1, 9\n*ELEMENT"), "*NGEN is not read"),
    "another system": (lambda text: text.replace("*NODE", "*System\n1, 1, 0\n*NODE"), "*SYSTEM is not read"),
    "polar nodes": (lambda text: text.replace("*NODE", "*NODE, SYSTEM=C"), "SYSTEM is not read"),
    "nodes in a file": (lambda text: text.replace("*NODE", "*NODE, INPUT=nodes.txt"), "INPUT is not read"),
    "a shifted instance": (
        lambda text: text + "*INSTANCE, NAME=one, PART=flat\n0.1, 0, 0\n*END INSTANCE\n",
        "the shift of *INSTANCE is not read",
    ),
    "a set twice": (lambda text: text + "*NSET, NSET=Contact\n1, 2\n", "the set 'contact' once; 2 *NSET"),
    "a set of elements": (
        lambda text: text + "*ELEMENT, TYPE=T2D2, ELSET=face\n9001, 1, 2\n",
        "must have the set 'face' as *ELSET after the elements",
    ),
}  # fmt: skip


def test_a_sound_deck_is_read(mesh, text, tmp_path):
    assert deck.fault([text.encode()], ("contact", "back")) == ""
    back = read(FIELD, at(tmp_path, "** first\n" + text.replace("\n", "\r\n") + "** last\n"))
    assert np.array_equal(back.points, mesh.points)
    assert len(back.lines["contact"]) == len(mesh.lines["contact"])


@pytest.mark.parametrize("case", CASES)
def test_what_meshio_would_read_as_another_mesh_is_refused(text, tmp_path, case):
    change, message = CASES[case]
    assert change(text) != text
    assert message in line_of(read, FIELD, at(tmp_path, change(text)))


def test_nodes_of_an_included_file_count(text, tmp_path):
    (tmp_path / "more.inp").write_text("*NODE\n1, 0, 0, 0\n")
    assert "one block *NODE" in line_of(read, FIELD, at(tmp_path, f"*INCLUDE, INPUT=more.inp\n{text}"))


def test_two_meshes_in_one_file_of_gmsh_are_refused(mesh, tmp_path):
    points = np.column_stack([mesh.points, 0 * mesh.points[:, 0]])
    meshio.write(tmp_path / "body.msh", meshio.Mesh(points, [("triangle", mesh.triangles)]), file_format="gmsh22")
    text = (tmp_path / "body.msh").read_bytes()
    (tmp_path / "body.msh").write_bytes(text + b"\n" + text)
    assert "must have one section $Nodes, not 2" in line_of(read, FIELD, str(tmp_path / "body.msh"))


@pytest.mark.fault
def test_a_second_part_that_is_not_seen(mesh, text, tmp_path, monkeypatch):
    """Without the check the nodes of the second part replace those of the first: the body is 5 % higher."""
    monkeypatch.setattr(deck, "fault", lambda *_: "")
    back = read(FIELD, at(tmp_path, doubled(text)))
    assert np.ptp(back.points[:, 1]) == pytest.approx(1.05 * np.ptp(mesh.points[:, 1]), rel=1e-9)


@pytest.mark.parametrize("lines", [
    "*ELSET, ELSET=contact\n1, 2\n*ELEMENT, TYPE=T2D2\n9001, 1, 2\n",
    "*ELSET, ELSET=a\n1, 2\n*ELSET, ELSET=contact\na\n*ELEMENT, TYPE=T2D2\n9001, 1, 2\n",
    "*ELSET, ELSET=contact\n99999\n", "*ELSET, ELSET=contact\n", "*NSET, NSET=contact, GENERATE\n1, 5\n",
    "*ELSET, ELSET=contact\nx\n", "*ELEMENT, TYPE=T2D2\n9001, 1\n", "*ELEMENT\n1, 2\n", "*NSET\n1\n",
    "*NSET, NSET\n1\n",
    "*ELEMENT, TYPE=T2D2, ELSET\n1, 2\n",
])  # fmt: skip
def test_sets_that_are_none_are_read_or_refused(text, tmp_path, lines):
    """Elements before and after their sets, sets of sets, and damaged ones."""
    place = text.index("*NSET, NSET=contact")
    rest = text[text.index("*NSET", place + 1) :]
    with contextlib.suppress(InputError):
        read(FIELD, at(tmp_path, text[:place] + lines + rest))
