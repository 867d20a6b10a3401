"""Decks of Abaqus and CalculiX: layouts that mean one mesh are read as one; what is not read is named."""

import re
from dataclasses import replace

import meshio
import numpy as np
import pytest
from refusing import line_of

from partialslip_meshes import abaqus, block, read

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
    """The deck as a part, and a second part with the same numbers, its nodes farther down."""
    moved = []
    for line in nodes(text):
        number, x, y, z = line.split(",")
        moved.append(f"{number},{x},{float(y) * (1 + shift)},{z}")
    cells = re.search(r"\*ELEMENT.*\n(?:[^*].*\n)*", text)[0]
    other = "*NODE\n" + "\n".join(moved) + "\n" + cells
    return f"*PART, NAME=FLAT\n{text}*END PART\n*PART, NAME=INSERT\n{other}*END PART\n"


PLANE = "must have plane elements (CPE, CPS), not"
SECOND = (
    "must be one piece, connected by common nodes, not 2; if it has more bodies, type body = ..., one of FLAT, INSERT"
)
CASES = {
    "a second body": (doubled, SECOND),
    "a node twice": (lambda text: between(text, nodes(text)[3]), "must have each node once; 1 are there again"),
    "made nodes": (lambda text: text.replace("*ELEMENT", "*NGEN\n1, 9\n*ELEMENT"), "*NGEN is not read"),
    "another system": (lambda text: text.replace("*NODE", "*System\n1, 1, 0\n*NODE"), "*SYSTEM is not read"),
    "polar nodes": (lambda text: text.replace("*NODE", "*NODE, SYSTEM=C"), "SYSTEM is not read"),
    "nodes in a file": (lambda text: text.replace("*NODE", "*NODE, INPUT=nodes.txt"), "INPUT is not read"),
    "a comma left out": (lambda text: text.replace("*NSET, NSET=left", "*NSET NSET=left"),
     "commas as in Abaqus; '*NSET N"),
    "an element twice": (lambda text: text + "*ELEMENT, TYPE=T2D2\n1, 1, 2\n", "must have each element once; 1 are"),
    "solid elements": (lambda text: text.replace("R3D3", "C3D4"), f"{PLANE} C3D4"),
    "nodes left out": (lambda text: text.replace("R3D3", "CPE4"),
     "must have a number and 4 nodes for each element CPE4"),
    "a node that is none": (lambda text: text + "*NSET, NSET=Contact\n99999\n", "set 'contact' has the node 99999"),
    "a set of itself": (lambda text: text + "*NSET, NSET=Contact\ncontact\n", "NSET 'contact' refers to itself"),
    "a part that is none": (lambda text: f"{text}*INSTANCE, NAME=B, PART=C\n*END INSTANCE\n", "'C' is no *PART"),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_what_is_not_read_is_named(text, tmp_path, case):
    change, message = CASES[case]
    assert change(text) != text
    assert message in line_of(read, FIELD, at(tmp_path, change(text)))


def test_a_sound_deck_is_read(mesh, text, tmp_path):
    back = read(FIELD, at(tmp_path, "** first\n" + text.replace("\n", "\r\n") + "** last\n"))
    assert np.array_equal(back.points, mesh.points)
    assert len(back.lines["contact"]) == len(mesh.lines["contact"])


def test_nodes_of_an_included_file_count(text, tmp_path):
    (tmp_path / "more.inp").write_text("*NODE\n1, 0, 0, 0\n")
    assert "must have each node once" in line_of(read, FIELD, at(tmp_path, f"*INCLUDE, INPUT=more.inp\n{text}"))


def test_a_file_that_includes_itself_is_refused(text, tmp_path):
    assert "must not include itself" in line_of(read, FIELD, at(tmp_path, f"*INCLUDE, INPUT=body.inp\n{text}"))


def sets_as(text, **changes):
    """The deck with other ``changes``: what replaces a group's set of nodes, by its name."""
    for name, lines in changes.items():
        text = re.sub(rf"\*NSET, NSET={name}\n(?:[^*].*\n)*", lines, text)
    return text


def members(text, name):
    """Numbers of the nodes of a set."""
    return [int(each) for each in re.findall(r"\d+", re.search(rf"\*NSET, NSET={name}\n((?:[^*].*\n)*)", text)[1])]


def same(back, mesh):
    """Whether the body is ``mesh``."""
    edges = [
        sorted(map(tuple, np.sort(pairs, axis=1).tolist())) for each in (back, mesh) for pairs in each.lines.values()
    ]
    return np.array_equal(back.points, mesh.points) and edges[: len(edges) // 2] == edges[len(edges) // 2 :]


def faces(mesh, name, letter="S", first=0):
    """A surface by the sides of elements that make up a line, which are counted from ``first`` + 1."""
    wanted = {tuple(pair) for pair in np.sort(mesh.lines[name], axis=1).tolist()}
    found = {}
    for number, corners in enumerate(mesh.triangles.tolist(), start=1):
        for side in range(3):
            if tuple(sorted((corners[side], corners[(side + 1) % 3]))) in wanted:
                found.setdefault(side + 1, []).append(number)
    numbers = {side: "".join(f"{each},\n" for each in those) for side, those in found.items()}
    sets = "".join(f"*ELSET, ELSET=_{name}_S{side}\n{those}" for side, those in numbers.items())
    labels = "".join(f"_{name}_S{side}, {letter}{side + first}\n" for side in found)
    return sets + f"*SURFACE, TYPE=ELEMENT, NAME={name}\n{labels}"


def listed(text, name):
    """Members of a set of nodes, a line each."""
    return ",\n".join(map(str, members(text, name))) + "\n"


def layouts(mesh, text):
    """Decks that mean the same body; of the last one it is the instance FLAT-1, 3 to the right."""
    nodes_of_back, first = listed(text, "back"), members(text, "back")[0]
    rest = ",\n".join(map(str, members(text, "back")[1:])) + "\n"
    part = re.sub(r"\*NSET, NSET=back\n(?:[^*].*\n)*", "", text)
    turn = "3., 0., 0., 3., 0., 1., 0."
    return {
        "comments between lines": between(text, "** more"),
        "nodes in two blocks": between(text, "*Node, nset=REST"),
        "a reference node": text + "*NODE\n9001, 0, 9, 0\n*NSET, NSET=REF\n9001\n",
        "a spring": text + "*ELEMENT, TYPE=SPRINGA, ELSET=SPRINGS\n9001, 1, 2\n",
        "quoted and lower-case names": text.replace("*NSET, NSET=contact", '*nset , nset = "Contact"'),
        "a set of sets": sets_as(text, back=f"*NSET, NSET=other\n{nodes_of_back}*NSET, NSET=Back\nOTHER\n"),
        "a set in two cards": sets_as(text, back=f"*NSET, NSET=back\n{first}\n*NSET, NSET=BACK\n{rest}"),
        "surfaces of sides": sets_as(text, contact=faces(mesh, "contact"), back=faces(mesh, "back")),
        "a surface of nodes": sets_as(
            text, back=f"*NSET, NSET=b\n{nodes_of_back}*SURFACE, TYPE=NODE, NAME=BACK\nb, 1.\n"
        ),
        "generated": sets_as(text, back="*NSET, NSET=back, GENERATE\n1\n3\n36, 40\n"),
        "numbers far beyond": text + "*NSET, NSET=back, GENERATE\n1, 99999999999999, 99999999\n",
        "a rigid surface": text + "*SURFACE, TYPE=SEGMENTS, NAME=RIGID\nSTART, -1., 1.\nLINE, 1., 1.\n",
        "a union of surfaces": sets_as(
            text, back=faces(mesh, "back").replace("NAME=back", "NAME=b") + "*SURFACE, NAME=back, COMBINE=UNION\nb\n"
        ),
        "exponents of Fortran": text.replace("e+00,", "D+00,"),
        "edges of shells": sets_as(text, back=faces(mesh, "back", "E")).replace("R3D3", "S3"),
        "sides of shells, by CalculiX": sets_as(text, back=faces(mesh, "back", "S", 2)).replace("R3D3", "S3"),
        "triangles as quadrilaterals": re.sub(
            r"R3D3\n((?:[^*].*\n)*)", lambda found: "CPE4\n" + re.sub(r",(\d+)\n", r",\1,\1\n", found[1]), text
        ),
        "instances": f"*PART, NAME=FLAT\n{part}*END PART\n*ASSEMBLY, NAME=A\n"
        f"*INSTANCE, NAME=FLAT-1, PART=FLAT\n0.125, 0.\n{turn}\n*END INSTANCE\n"
        "*INSTANCE, NAME=FLAT-2, PART=FLAT\n0., 9.\n*END INSTANCE\n"
        f"*NSET, NSET=BACK, INSTANCE=FLAT-1\n{nodes_of_back}*NODE\n1, 0, 20\n*END ASSEMBLY\n",
    }


def test_layouts_of_decks_make_no_difference(mesh, text, tmp_path):
    for layout, made in layouts(mesh, text).items():
        placed = layout == "instances"
        back = read(FIELD, at(tmp_path, made), body="flat-1" if placed else None)
        assert made != text, layout
        assert np.abs(back.points - [0.125 * placed, 0] - mesh.points).max() <= 1e-15 * placed * 4, layout
        assert same(replace(back, points=mesh.points), mesh), layout


@pytest.mark.parametrize(("lines", "said"), [
    ("*SURFACE, NAME=CONTACT\n99999, S3\n", "must have elements that exist; the surface 'contact' has"),
    ("*SURFACE, NAME=CONTACT, TYPE=SEGMENTS\nSTART, -1., 1.\n", "'contact' is of SEGMENTS"),
    ("*SURFACE, NAME=CONTACT, COMBINE=UNION\ncontact\n", "SURFACE 'contact' refers to itself"),
    ("*NSET, NSET=contact, GENERATE\n9, 3\n", "a first number, a last one and a step below GENERATE, not 9, 3"),
])  # fmt: skip
def test_groups_that_cannot_be_meant_are_told(text, tmp_path, lines, said):
    assert said in line_of(read, FIELD, at(tmp_path, text + lines))


def test_a_group_of_the_other_body_is_told(text, tmp_path):
    told = line_of(read, FIELD, at(tmp_path, doubled(text)), body="INSERT", groups={"contact": "FLAT.contact"})
    assert "group 'FLAT.contact' must have an edge of the boundary of the body" in told


def test_a_body_beside_the_contact_is_told_where_it_is(mesh, text, tmp_path):
    made = layouts(mesh, text)["instances"].replace("0.125, 0.", "9., 0.")
    told = line_of(read, FIELD, at(tmp_path, made), body="flat-1")
    assert "contact line must have x = 0 inside; in the file it is from x = 8.7 to 9.3: move the body" in told


def test_a_part_with_one_instance_has_both_names(mesh, text, tmp_path):
    made = layouts(mesh, text)["instances"].replace("*INSTANCE, NAME=FLAT-2, PART=FLAT\n0., 9.\n*END INSTANCE\n", "")
    for body in ("FLAT-1", "flat", None):
        assert same(replace(read(FIELD, at(tmp_path, made), body=body), points=mesh.points), mesh)


@pytest.mark.parametrize("kind", ["CPE3", "cps3", "CPE3H", "CPS3T", "S3R"])
def test_types_of_plane_elements(mesh, text, tmp_path, kind):
    assert same(read(FIELD, at(tmp_path, text.replace("R3D3", kind))), mesh)


def test_groups_have_the_names_that_the_file_gives_them(mesh, text, tmp_path):
    renamed = text.replace("NSET=contact", "NSET=SLAVE")
    assert same(read(FIELD, at(tmp_path, renamed), groups={"contact": "Slave"}), mesh)
    told = line_of(read, FIELD, at(tmp_path, renamed))
    assert "must have a group 'contact' of edges or nodes of its boundary; the file has SLAVE, face, back" in told
    told = line_of(read, FIELD, at(tmp_path, renamed), groups={"contact": "MASTER"})
    assert "must have the group 'MASTER' of edges or nodes for 'contact'; the file has SLAVE" in told


def test_one_of_two_bodies_is_chosen(mesh, text, tmp_path):
    assert same(read(FIELD, at(tmp_path, doubled(text)), body="flat"), mesh)
    assert "elements of the body 'PAD'; the file has FLAT, INSERT" in line_of(
        read, FIELD, at(tmp_path, doubled(text)), body="PAD"
    )


def test_two_meshes_in_one_file_of_gmsh_are_refused(mesh, tmp_path):
    points = np.column_stack([mesh.points, 0 * mesh.points[:, 0]])
    meshio.write(tmp_path / "body.msh", meshio.Mesh(points, [("triangle", mesh.triangles)]), file_format="gmsh22")
    text = (tmp_path / "body.msh").read_bytes()
    (tmp_path / "body.msh").write_bytes(text + b"\n" + text)
    assert "must have one section $Nodes, not 2" in line_of(read, FIELD, str(tmp_path / "body.msh"))


@pytest.mark.fault
def test_numbers_of_two_parts_taken_for_one(text, tmp_path, monkeypatch):
    """Scopes left out: the nodes of the second part stand in for those of the first, and the deck is refused."""
    kept = abaqus._cards
    monkeypatch.setattr(abaqus, "_cards", lambda text: (card for card in kept(text) if "PART" not in card.keyword))
    assert "must have each node once" in line_of(read, FIELD, at(tmp_path, doubled(text)), body="flat")
