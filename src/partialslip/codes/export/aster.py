"""Commands, mesh and export file for Code_Aster: the continuous contact formulation. Never run by this project."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from partialslip.codes.export.model import Model
from partialslip.codes.export.named_boundaries import Named, heading, named
from partialslip.scene import Scene
from partialslip.tools.arrays import Indices

_WIDEST = 80  # fixed: columns that Code_Aster reads of a line of its mesh files
_MESH, _TABLE = 20, 38  # fixed: logical units of the mesh and of the table of tractions

_OUTPUT = """\
ONE, TWO = T1.EXTR_TABLE().values(), T2.EXTR_TABLE().values()
with open('fort.{unit}', 'w') as OUT:
    OUT.write('x,p1,p,q1,q2\\n')
    for X, C1, C2, L1, L2 in sorted(zip(ONE['COOR_X'], ONE['LAGS_C'], TWO['LAGS_C'], {L1}, {L2})):
        OUT.write('%.12e,%.12e,%.12e,%.12e,%.12e\\n' % (X, -C1, -C2, -F * C1 * L1, -F * C2 * L2))
FIN()"""


def aster_files(scene: Scene, model: Model, name: str) -> dict[str, bytes]:
    """Files of the deck by name: ``name``.comm, ``name``.mail and ``name``.export. Parameters and errors as of
    :func:`partialslip.codes.export.named_boundaries.named`."""
    made = named(scene, model, "code-aster")
    notes = (
        "for Code_Aster 16 or later; time counts increments",
        f"{name}.csv has tractions of load points 1 and 2, times {made.ends[0]} and {made.ends[1]}:",
        "p = -LAGS_C, q = f p LAGS_F1",
        *(
            ("the sign of q is that of Code_Aster's tangent: partialslip score says if it is the other one",)
            * bool(model.f)
        ),
    )
    comm = [*heading(scene, model, "Code_Aster deck", notes), *_commands(made)]
    export = [
        "P actions make_etude",
        "P version stable",
        "P time_limit 36000",
        "P memory_limit 4096",
        f"F comm {name}.comm D 1",
        f"F mail {name}.mail D {_MESH}",
        f"F mess {name}.mess R 6",
        f"F libr {name}.csv R {_TABLE}",
    ]
    texts = {f"{name}.comm": comm, f"{name}.mail": [*_mesh(made)], f"{name}.export": export}
    return {file: ("\n".join(lines) + "\n").encode("ascii") for file, lines in texts.items()}


def _mesh(made: Named) -> Iterator[str]:
    """Lines of the mesh: nodes N1 and so on, elements M1 and so on; groups of elements BODY and BODY_LINE; groups of
    nodes HELD_X, HELD_Y, FRAME_X, FRAME_Y, FIRST (of FRAME_X) and TOUCH (the lower contact line)."""
    nodes: dict[str, Indices] = {}
    cells: dict[str, Indices] = {}
    quads, edges, first = [], [], 1
    yield "COOR_2D"
    for body, mesh in made.meshes.items():
        for number, (x, y) in enumerate(mesh.points.tolist(), start=first):
            yield f"N{number} {x:.14e} {y:.14e}"
        lines = {name: np.unique(line) + first for name, line in mesh.lines.items()}
        if body == "lower":
            nodes["TOUCH"] = lines["contact"]
            nodes |= {f"HELD_{axis}": np.unique(np.concatenate([lines[line] for line in each]))
                      for axis, each in zip("XY", made.held, strict=True)}  # fmt: skip
        else:
            nodes |= {f"FRAME_{axis}": lines[line] for axis, line in zip("XY", made.frame, strict=True)}
            nodes["FIRST"] = nodes["FRAME_X"][:1]
        quads.append((body.upper(), mesh.quads + first))
        edges += [(_group(body, line), each + first) for line, each in mesh.lines.items()]
        first += len(mesh.points)
    yield "FINSF"
    number = 1
    for kind, blocks in (("QUAD4", quads), ("SEG2", edges)):
        yield kind
        for group, each in blocks:
            cells[group] = np.arange(number, number + len(each))
            yield from (f"M{k} " + " ".join(f"N{node}" for node in row) for k, row in enumerate(each.tolist(), number))
            number += len(each)
        yield "FINSF"
    for keyword, letter, groups in (("GROUP_MA", "M", cells), ("GROUP_NO", "N", nodes)):
        for group, members in groups.items():
            yield f"{keyword} NOM={group}"
            yield from _wrapped(f"{letter}{member}" for member in members.tolist())
            yield "FINSF"
    yield "FIN"


def _group(body: str, line: str) -> str:
    """Name of the group of the edges of a ``line``."""
    return f"{body}_{line}".upper().replace("-", "_")


def _wrapped(words: Iterable[str]) -> Iterator[str]:
    line = ""
    for word in words:
        if line and len(line) + 1 + len(word) > _WIDEST:
            yield line
            line = ""
        line = f"{line} {word}".lstrip()
    yield line


def _commands(made: Named) -> Iterator[str]:
    model, f = made.model, made.model.f
    yield "DEBUT()"
    yield f"MESH = LIRE_MAILLAGE(FORMAT='ASTER', UNITE={_MESH})"
    sides = ", ".join(f"'{_group(body, line)}'" for body, mesh in made.meshes.items() for line in mesh.lines)
    yield f"MESH = MODI_MAILLAGE(reuse=MESH, MAILLAGE=MESH, ORIE_PEAU=_F(GROUP_MA_PEAU=({sides})))"
    yield "MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='D_PLAN'))"
    bodies = [part.name.upper() for part in model.parts]
    for body, part in zip(bodies, model.parts, strict=True):
        yield f"{body} = DEFI_MATERIAU(ELAS=_F(E={part.E:.12e}, NU={part.nu:.12e}))"
    given = ", ".join(f"_F(GROUP_MA='{body}', MATER={body})" for body in bodies)
    yield f"FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=({given}))"
    yield from _loads(made)
    kind, solved = ("'COULOMB'", ", ALGO_RESO_FROT='NEWTON'") if f else ("'SANS'", "")
    zone = "GROUP_MA_MAIT='UPPER_CONTACT', GROUP_MA_ESCL='LOWER_CONTACT', CONTACT_INIT='INTERPENETRE'"
    zone += f", COULOMB={f:.12e}" if f else ""
    yield f"TOUCH = DEFI_CONTACT(MODELE=MODEL, FORMULATION='CONTINUE', FROTTEMENT={kind},"
    yield f"    ALGO_RESO_GEOM='POINT_FIXE', REAC_GEOM='SANS', ALGO_RESO_CONT='NEWTON'{solved},"
    yield f"    ZONE=_F({zone}))"
    yield "COMMON = dict(MODELE=MODEL, CHAM_MATER=FIELD, CONTACT=TOUCH, COMPORTEMENT=_F(RELATION='ELAS'),"
    yield "    NEWTON=_F(MATRICE='TANGENTE', REAC_ITER=1), CONVERGENCE=_F(RESI_GLOB_RELA=1e-8, ITER_GLOB_MAXI=100))"
    yield "RES1 = STAT_NON_LINE(EXCIT=LOADS + [_F(CHARGE=GUIDE)],"
    yield f"    INCREMENT=_F(LIST_INST=TIMES, INST_FIN={made.guided:.1f}), **COMMON)"
    result = "RES1"
    if made.guided < made.times[-1]:
        result = "RES2"
        yield "RES2 = STAT_NON_LINE(EXCIT=LOADS, ETAT_INIT=_F(EVOL_NOLI=RES1), INCREMENT=_F(LIST_INST=TIMES), **COMMON)"
    asked = "'LAGS_C', 'LAGS_F1'" if f else "'LAGS_C',"
    for number, time in enumerate(made.ends, start=1):
        yield f"T{number} = CREA_TABLE(RESU=_F(RESULTAT={result}, NOM_CHAM='DEPL', GROUP_NO='TOUCH', INST={time:.1f},"
        yield f"    NOM_CMP=({asked})))"
    yield f"F = {f:.12e}"
    shears = ("ONE['LAGS_F1']", "TWO['LAGS_F1']") if f else ("ONE['LAGS_C']", "TWO['LAGS_C']")  # times F = 0
    yield _OUTPUT.format(unit=_TABLE, L1=shears[0], L2=shears[1])


def _loads(made: Named) -> Iterator[str]:
    """Loads over time; LOADS are all but the guide of the frame."""
    for load in ("P", "Q", "sigma"):
        yield f"F{load[0].upper()} = DEFI_FONCTION(NOM_PARA='INST', VALE=("
        yield from _pairs((0, *made.times), made.load(load))
        yield "))"
    starts = (0, *(time for time in made.times[:-1]))
    steps = [f"_F(JUSQU_A={time:.1f}, NOMBRE={time - start})" for start, time in zip(starts, made.times, strict=True)]
    yield "TIMES = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=("
    yield from (f"    {step}," for step in steps)
    yield "))"
    for axis, strain in zip("XY", made.model.parts[0].strained.tolist(), strict=True):
        yield f"U{axis} = FORMULE(NOM_PARA=('X', 'Y'), VALE='{strain:.12e} * {axis}')"
    yield "BULK = AFFE_CHAR_MECA_F(MODELE=MODEL,"
    yield "    DDL_IMPO=(_F(GROUP_NO='HELD_X', DX=UX), _F(GROUP_NO='HELD_Y', DY=UY)))"
    yield "FRAME = AFFE_CHAR_MECA(MODELE=MODEL,"
    yield "    LIAISON_UNIF=(_F(GROUP_NO='FRAME_X', DDL='DX'), _F(GROUP_NO='FRAME_Y', DDL='DY')))"
    yield "GUIDE = AFFE_CHAR_MECA(MODELE=MODEL, DDL_IMPO=_F(GROUP_NO='FIRST', DX=0.0))"
    for charge, component, line in (("SHEAR", "FX", made.frame[0]), ("PRESS", "FY", made.frame[1])):
        force = f"{component}={-1 / made.length(line):.12e}"
        yield f"{charge} = AFFE_CHAR_MECA(MODELE=MODEL, FORCE_CONTOUR=_F(GROUP_MA='{_group('upper', line)}', {force}))"
    charges = ["_F(CHARGE=FRAME)", "_F(CHARGE=BULK, FONC_MULT=FS)", "_F(CHARGE=PRESS, FONC_MULT=FP)",
               "_F(CHARGE=SHEAR, FONC_MULT=FQ)"]  # fmt: skip
    if made.pulls:
        pulled = [f"_F(GROUP_MA='{_group('lower', line)}', FX={each:.12e})" for line, each in made.pulls.items()]
        yield f"PULL = AFFE_CHAR_MECA(MODELE=MODEL, FORCE_CONTOUR=({', '.join(pulled)},))"
        charges.append("_F(CHARGE=PULL, FONC_MULT=FS)")
    yield f"LOADS = [{', '.join(charges)}]"


def _pairs(times: Sequence[int], values: Sequence[float]) -> Iterator[str]:
    """Rows of time and value of a function."""
    return (f"    {time:.1f}, {value:.12e}," for time, value in zip(times, values, strict=True))
