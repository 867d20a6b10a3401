"""Rigs in files: what is read is what was written, for the same bodies only; what cannot be meant is one line."""

import json
import re
import shutil

import numpy as np
import pytest
from refusing import line_of

from partialslip import load_scene, run
from partialslip.result.rig import Rig, Terms, key_of, load_rig, write_rig
from partialslip.run import characterise, rig_of
from partialslip.scene.reading import scene_toml
from partialslip.tools.errors import InputError

SCENE = "hertz-small-tension"
BLOCKS = ("bodies.upper={width=16e-3, height=8e-3}", "bodies.lower={width=16e-3, height=8e-3}")
PAD = "bodies.upper={kind='pad', width=16e-3, height=8e-3}"


def scene_of(*settings):
    return load_scene(SCENE, [*BLOCKS, *settings])


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("rig") / "rig.json"
    write_rig(characterise(scene_of()), path)
    return path


@pytest.fixture
def path(file, tmp_path):
    """A copy of the file, to be spoiled."""
    return shutil.copy(file, tmp_path / "rig.json")


def referring(path, *settings):
    return scene_of(f"bodies.equivalent='{path}'", *settings)


def test_a_rig_is_read_as_it_was_written(file):
    own, read = characterise(scene_of()), load_rig(file)
    assert (own.key, own.reach) == (read.key, read.reach)
    for kind in ("terms", "rough"):
        for one, other in zip(getattr(own, kind), getattr(read, kind), strict=True):
            assert np.array_equal(one, other)


def test_results_are_the_same_bit_for_bit(file):
    one, other = (run(scene, ["equivalent"])["equivalent"] for scene in (scene_of(), referring(file)))
    assert (one.a, one.m, one.n, one.ends, one.estimate) == (other.a, other.m, other.n, other.ends, other.estimate)
    assert np.array_equal(one.traction.dq, other.traction.dq)


OTHER = {
    "half-plane": "bodies.upper=None", "width": "bodies.upper.width=16.1e-3", "height": "bodies.lower.height=9e-3",
    "holder": "bodies.lower.holder={width=16e-3, height=1e-3}", "support": "bodies.lower.support='roller'",
    "pulled": ("bodies.lower.support='roller'", "bodies.lower.pulled=true"), "pad": "bodies.upper.kind='pad'",
    "E": "material.E=7e10", "nu": "material.nu=0.31", "plane": "material.plane='stress'",
}  # fmt: skip


@pytest.mark.parametrize("what", OTHER)
def test_the_rig_of_other_bodies_is_refused(file, what):
    changes = OTHER[what]
    if what == "half-plane":
        scene = load_scene(SCENE, [BLOCKS[1], f"bodies.equivalent='{file}'"])
    else:
        scene = referring(file, *([changes] if isinstance(changes, str) else changes))
    said = f"^{re.escape(str(file))}: this rig has other bodies, supports or materials than {SCENE}; must be made"
    assert re.search(said, line_of(run, scene, ["equivalent"]))


@pytest.mark.parametrize(
    "change",
    ["load.Q=[0, 1e5]", "load.sigma=[0, 0]", "load.p0=3e8", "friction.f=0.9", "profile.R=0.04", "fem.accuracy=1e-2"],
)
def test_other_loads_friction_and_profiles_have_the_same_rig(file, change):
    assert rig_of(referring(file, change)).reach == 4e-3


def test_the_profile_of_a_pad_is_part_of_its_rig():
    keys = [key_of(load_scene(SCENE, [PAD, f"profile.R={R}"])) for R in (0.04, 0.05)]
    assert keys[0] != keys[1]


def test_the_content_of_a_mesh_counts_not_its_name(tmp_path):
    first, second = tmp_path / "a.msh", tmp_path / "b.msh"
    first.write_text("one")
    shutil.copy(first, second)
    one, other = (key_of(load_scene(SCENE, [f"bodies.lower={{mesh='{path}'}}"])) for path in (first, second))
    assert one == other
    second.write_text("two")
    assert key_of(load_scene(SCENE, [f"bodies.lower={{mesh='{second}'}}"])) != one


NOTE = "the file of bodies.equivalent was edited since partialslip wrote it; the results are those of its numbers"


def test_an_edited_rig_is_said_and_used(path, tmp_path):
    """It changed the answer in silence."""
    again = tmp_path / "again.json"
    before = run(referring(path), ["equivalent"])["equivalent"]
    spoiled(lambda data: data.update(sum=data["sum"]))(path)  # written anew by another program
    assert not load_rig(path).edited
    spoiled(lambda data: data["terms"]["xx"][1].__setitem__(1, 3 * data["terms"]["xx"][1][1]))(path)
    after = run(referring(path), ["equivalent"])["equivalent"]
    assert abs(after.m - before.m) > 1e-4 * before.a
    assert NOTE not in before.notes
    assert after.notes[0] == NOTE
    rig = load_rig(path)
    assert rig.edited
    assert rig.uncoupled.edited
    assert rig.coarser.edited
    write_rig(rig, again)  # with a checksum of its own
    assert load_rig(again).edited
    assert run(referring(again), ["equivalent"])["equivalent"].notes[0] == NOTE


@pytest.mark.fault
@pytest.mark.parametrize("kind", ["terms", "rough"])
def test_a_changed_digit_of_a_rig_is_seen(file, path, kind):
    """Every number, by one part in 1e12."""
    for name, rows in json.loads(file.read_text())[kind].items():
        for i, j in np.ndindex(np.shape(rows)):
            if rows[i][j]:

                def change(data, name=name, i=i, j=j):
                    data[kind][name][i][j] *= 1 + 1e-12
                    if name.removeprefix("lower_") in ("xx", "yy"):
                        data[kind][name][j][i] = data[kind][name][i][j]

                shutil.copy(file, path)
                spoiled(change)(path)
                assert load_rig(path).edited


def test_rigs_without_a_checksum_are_read(path):
    """Those of earlier versions."""
    spoiled(lambda data: data.pop("sum"))(path)
    assert not load_rig(path).edited


def test_rigs_are_found_beside_the_scene(file, tmp_path, monkeypatch):
    (tmp_path / "scenes").mkdir()
    shutil.copy(file, tmp_path / "scenes" / "rig.json")
    text = scene_toml(scene_of()) + '\n[bodies]\nequivalent = "rig.json"\n'
    (tmp_path / "scenes" / "mine.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    scene = load_scene("scenes/mine.toml")
    assert rig_of(scene).key == load_rig(file).key


def spoiled(change):
    def of(path):
        data = json.loads(path.read_text())
        change(data)
        path.write_text(json.dumps(data))

    return of


def folder(path):
    path.unlink()
    path.mkdir()


def large(path):
    with path.open("r+b") as file:
        file.truncate(2**30)


def more_terms(data):
    for kind in ("terms", "rough"):
        data[kind]["xx"].append(data[kind]["xx"][0])


def term(kind, name, row, column, value):
    return spoiled(lambda data: data[kind][name][row].__setitem__(column, value))


def rewritten(change):
    return lambda path: path.write_text(change(path.read_text()))


SPOILED = {
    "null": (term("terms", "xx", 0, 0, None), "not a rig: .*: must be a number, not null"),
    "text": (term("terms", "xx", 0, 0, "1"), "not a rig: .*: must be a number, not a string"),
    "no reach": (spoiled(lambda data: data.pop("reach")), "not a rig: reach: missing"),
    "negative reach": (spoiled(lambda data: data.update(reach=-1.0)), "not a rig: .*reach"),
    "more": (spoiled(lambda data: data.update(more=1)), "not a rig: more: unknown key"),
    "shape": (spoiled(more_terms), r"terms.xx: must have 12 rows of 12 numbers|terms\.\w+: must have"),
    "short row": (
        spoiled(lambda data: data["rough"]["pulled"][0].pop()),
        "rough.pulled: must have 2 rows of 11 numbers",
    ),
    "asymmetry": (term("terms", "yy", 2, 0, 1.0), r"terms.yy: must be symmetric"),
    "schema": (
        spoiled(lambda data: data.update(schema="partialslip/rig/1")),
        "schema = 'partialslip/rig/1': must be 'partialslip/rig/2'",
    ),
    "a list": (rewritten(lambda _: "[]"), "not a rig: "),
    "not UTF-8": (lambda path: path.write_bytes(b'{"schema": "\xff\xfe"}'), "not a rig: "),
    "truncated": (rewritten(lambda text: text[:1000]), "not a rig: "),
    "1 GB": (large, "1073741824 bytes: must be at most 1048576"),
    "a folder": (folder, "cannot be read: Is a directory"),
    "absent": (lambda path: path.unlink(), "cannot be read: No such file"),
}  # fmt: skip


@pytest.mark.parametrize("how", SPOILED)
def test_spoiled_files_are_one_line(path, how):
    spoil, said = SPOILED[how]
    spoil(path)
    told = line_of(run, referring(path), ["equivalent"])
    assert re.search(said, told)
    assert told.startswith(str(path))
    assert len(told) < 400


@pytest.mark.parametrize(("i", "j", "value"), [(2, 0, 1e300), (2, 0, -1e3), (1, 0, 1e300), (1, 1, -1e9)])
def test_terms_that_mean_nothing_are_one_line(path, i, j, value):
    """A file may be well-formed and of no body: the line names the bodies, not data that nobody gave."""

    def change(data):
        for kind in ("terms", "rough"):
            data[kind]["yy"][i][j] = data[kind]["yy"][j][i] = value

    spoiled(change)(path)
    assert re.search(r"^bodies: must be ", line_of(run, referring(path), ["equivalent"]))


def test_files_that_cannot_be_written_are_one_line(tmp_path):
    rig = Rig("key", 1.0, *[Terms(*[np.zeros((2, 2))] * 7)] * 2)
    (tmp_path / "rig.json").mkdir()
    with pytest.raises(InputError):
        write_rig(rig, tmp_path / "rig.json")


def test_a_rig_without_bodies_is_refused():
    with pytest.raises(InputError, match=r"bodies.equivalent = 'rig.json': must be given only with bodies"):
        load_scene(SCENE, ["bodies.equivalent='rig.json'"])


def test_characterising_half_planes_is_refused():
    with pytest.raises(InputError, match="bodies: must have upper or lower"):
        characterise(load_scene(SCENE))


def test_rigs_are_kept_for_the_same_bodies():
    assert characterise(scene_of()) is characterise(scene_of("load.Q=[0, 1e5]", "friction.f=0.7"))
