"""Commands that are refused: in one line, before anything is solved or written."""

import shlex
from pathlib import Path

import pytest
from tests.bad_input.test_files import FRD, TABLE
from tests.bad_input.test_scenes import EXACT, GOOD, SHIPPED
from tests.cli.test_equivalent_command import TEXT

REFUSED = {  # by the first words of the command: others => how the line begins, or ...what is in it
    "run hertz-shear --with exact --set": """
'' => --set : must be table.key=value
= => --set =: must be table.key=value
load.P => --set load.P: must be table.key=value
load..P=3 => --set load..P=3: must be table.key=value
name.x=1 => --set name.x=1: name must be a table
load.Q.0=1 => --set load.Q.0=1: Q must be a table
load=1 => hertz-shear: load = 1: must be a table
load.p0= => --set load.p0=: not valid TOML:
'load.p0=x y' => hertz-shear: load.p0 = 'x y': must be a number
load.p0=1=2 => --set load.p0=1=2: not valid TOML:
""",
    "run hertz-shear --with exact": """
--bogus => unknown argument --bogus
extra => unknown argument extra
--accuracy fine => --accuracy 'fine': must be a number
--accuracy 0 => hertz-shear: fem.accuracy = 0.0: must be >= 1e-09
--out bench.toml => --out bench.toml: cannot be written
--out '' => --out '': must name a folder
--out /proc/x/y => --out /proc/x/y: cannot be written: No such file
--acc 1e-3 => unknown argument --acc: did you mean --accuracy? (see partialslip run --help)
""",
    "run hertz-shear --with march": """
--start none.npz => none.npz: cannot be read
--start '' => : cannot be read
--start . => .: cannot be read
--save '' => --save '': must name a file
--save . => .: cannot be written: is a folder
--save bench.toml/s.npz => --out bench.toml: cannot be written
""",
    "run hertz-shear --with fem --set fem.size=0.1 --set": """
effects.normal=false => hertz-shear: effects.normal = false: without pressure there is no contact; must be true
effects.friction=true --set friction.f=0.01 => ...|Q| >= f P at a load point: the contact slides
effects.friction=true --set friction.f=0 => hertz-shear: effects.friction = true: f = 0
effects.opposing-slip=false --set 'load.sigma=[-3e8,3e8]' => ...reverses slip at one end (large tension
effects.history=false --set 'load.sigma=[0,1e8,0]' --set 'load.Q=[0,1e4,1e4]' => ... false: Q and sigma are out of phase
effects.history=false --set 'material.upper={E=4e11,nu=0.3}' --set 'load.Q=[-1e5,1e5]' => ...depends on the path
effects.finite-size=true => ...ar: effects.finite-size = true: bodies.upper and bodies.lower have no size; must be false
effects.far-field=true --set 'bodies={lower={width=1,height=1},upper={width=1,height=1}}' => ...o half-plane around them
effects.frction=true => hertz-shear: effects.frction: unknown key; did you mean 'friction'?
effects.opposing_slip=true => hertz-shear: effects.opposing_slip: unknown key; did you mean 'opposing-slip'?
effects.friction=1 => hertz-shear: effects.friction = 1: must be true or false, not a whole number
""",
    "run hertz-shear": """
--with exat => --with 'exat': must be of exact, march, fem, equivalent; did you
--with exact,bem => --with 'bem': must be of exact, march, fem
--with '' => --with '': must be of exact, march, fem
--save s.npz --with exact => --save: no method has followed a path
--budget 0 => --budget '0': must be a number of seconds > 0, for example 5s
--budget -1s => --budget '-1s': must be a number of seconds > 0, for example 5s
--budget soon => --budget 'soon': must be a number of seconds > 0, for example 5s
--budget nan => --budget 'nan': must be a number of seconds > 0, for example 5s
--accuracy x => --accuracy 'x': must be a number, a fraction of a, for example 1e-4
--accuracy 1 => hertz-shear: fem.accuracy = 1.0: must be <= 0.1
--accuracy 1e-3 --budget 5s => --budget: must not be given together with --accuracy
--budget 50s --with exact => --budget: needs
--budget 50s --set fem.size=0.1 => --budget: needs
""",
    "score hertz-shear": """
 => FILE: missing
t.csv u.csv => u.csv: cannot be read
t.csv --template => --template t.csv: must go without a file
t.doc => t.doc: must end in .csv, .txt, .tsv, .rpt, .frd, .dat
t.csv --factors 1 => --factors 1: must be three numbers
t.csv --factors 1,1,nan => --factors 1,1,nan: must be finite and not zero
t.csv --factors 1,0,1 => --factors 1,0,1: must be finite and not zero
t.csv --factors 1,1e200,1 => t.csv: p = 1.74356e+208: must be zero or of a size
t.csv --factors 1,-1,1 => t.csv: p > 0 at 0 points: must be at least 6; pressure must be positive
t.csv --order 3 => --order 3: must be 1 or 2
t.csv --at 1,2 => --at 1,2: must be left out except for .frd and .dat files
t.frd --at 1 => --at 1: must be two whole numbers
t.frd --at 1,x => --at 1,x: must be two whole numbers
t.frd --at 0,1 => --at 0,1: must be from 1 to 2, contact results of t.frd
t.csv --bar 0 => --bar 0: must be one number, or three
t.csv --bar x => --bar x: must be one number, or three
t.csv --with bem => argument --with: invalid choice: 'bem
t.csv --out '' => --out '': must name a folder
t.csv --out t.csv => --out t.csv: cannot be written
t.csv --set load.P=1 => hertz-shear: load: exactly one of P, a, p0
--template --set load.p0=0 => hertz-shear: load.p0 = 0: must be > 0
--template --set material.upper.E=1e9 --set material.upper.nu=0.3 => material.upper, material.lower: the bodies differ
q.frd --set 'load.Q=[1e5,0,-1e5]' => q.frd: contact results of 2 steps: must be 3 or more, one per load point
""",
    "verify": """
--suite stress --method equivalent => --method 'equivalent': must be one of exact, march, fem
--suite quick --count 3 => --count 3: only with --suite stress
--suite full --only near-slide => --only 'near-slide': no case of the suite full; did you mean
--suite stress --count 0 => --count 0: must be a whole number from 1 to 999999999
--suite stress --seed x => argument --seed: invalid int value: 'x'
--suite stress --method bem => --method 'bem': must be one of exact, march, fem
--suite stress --only one => --only 'one': must be the number of a random scene
--suite stress --seed=-1 => --seed -1: must be a whole number from 0
--suite all => argument --suite
--processes 0 => --processes 0: must be >= 1
--include nowhere => --include nowhere: must be the folder of a study
""",
    "export hertz-large-tension": """
--to abaqus --size 0 => --size '0'
--to abaqus --size x => --size 'x'
--to ansys => argument --to: invalid choice: 'ansys
--to gmsh --penalty => penalty
--to gmsh --ends=0,2 => --ends '2'
--to gmsh --out '' => --out
 => the following arguments are required: --to
""",
    "map hertz-large-tension": """
--out file => --out file: cannot be written:
--out . => map.csv: cannot be written: is a folder
--bogus => unknown argument --bogus
--set friction.f=0 => friction.f = 0: must be > 0
""",
    "": """
 => the following arguments are required: COMMAND
bogus => argument COMMAND: invalid choice: 'bogus'
run => the following arguments are required: SCENE
fatigue hertz-shear --with exat => ...nvalid choice: 'exat' (choose from 'exact', 'march', 'fem'); did you mean 'exact'?
rnu hertz-shear => ...did you mean 'run'?
study cost hertz-shear --repeat=3 => ...argument --repeat=3: did you mean --repeats? (see partialslip study cost --help)
score => the following arguments are required: SCENE
score hertz-sheer t.csv => scene 'hertz-sheer': neither a file nor a shipped scene; did you mean 'hertz-shear'?
equivalent hertz-shear => hertz-shear: bodies: must have upper or lower
equivalent absent.toml => absent.toml: cannot be read
equivalent blocks.toml --set load.p0=2e9 => blocks.toml: bodies: must be larger compared with
equivalent blocks.toml --set material.E=-1 => blocks.toml: material.E = -1
equivalent blocks.toml --out blocks.toml => --out blocks.toml: cannot be written
score blocks.toml blocks.toml --with equivalent => ... invalid choice: 'equivalent' (choose from 'exact', 'march', 'fem'
map hertz-shear --set 'material={upper={E=2e11,nu=0.3},lower={E=7e10,nu=0.3}}' => ...must be of one material for a map
map --set friction.f=0.3 => --set friction.f=0.3: must have a SCENE, for example hertz-shear
completion fish => argument SHELL: invalid choice: 'fish' (choose from 'bash'
page flat-rounded => profile.kind = "flat-rounded": must be "hertz" for a live page (closed form for Hertz only)
benchmark run --code ../x => --code '../x': must be one of exact
benchmark run --code exact --problems , => --problems '': must be numbers of PS-01
benchmark read '' mine.csv -o mine => PROBLEM '': must be one of PS-01
benchmark read PS-01,PS-02 mine.csv -o mine => PROBLEM 'PS-01,PS-02': must be one of PS-01
""",
}  # fmt: skip
# of hertz-shear, ~ being bodies.lower
SETTINGS = """
~={} => ~.width: missing
~={width=1.0} => ~.height: missing
~={width=0, height=1} => ~.width = 0: must be > 0
~={width=1, height='1'} => ~.height = '1': must be a number, not a string
~={BLOCK, colour=1} => ~.colour: unknown key; known are kind, width, height, holder, mesh
~={kind='cylinder', BLOCK} => ~.kind = 'cylinder': must be one of 'block', 'pad'
~={support='glued', BLOCK} => ~.support = 'glued': must be one of 'clamped', 'roller', 'sides', 'pivot'
~={pulled=1, BLOCK} => ~.pulled = 1: must be true or false, not a whole number
~={pulled=true, BLOCK} => ~.pulled = true: must have support 'roller' or 'sides', not 'clamped'
~={holder={width=1}, BLOCK} => ~.holder.height: missing
~={holder={width=1, height=1, x=1}, BLOCK} => ~.holder.x: unknown key; known are width, height
~={holder=1, BLOCK} => ~.holder = 1: must be a table, not a whole number
~={holder={width=1, height=1e-5}, BLOCK} => ~.holder.height = 1e-05: must be 0.0001 to 10000 times the width
~={width=1, height=1e5} => ~.height = 100000.0: must be 0.0001 to 10000 times the width, 1
~={body='PAD', BLOCK} => ~.body = 'PAD': must be given only together with mesh
~={mesh='a.msh', groups={kontakt=1}} => ~.groups.kontakt: unknown key; did you mean 'contact'?
~={unit=1e-3, BLOCK} => ~.unit = 0.001: must be given only together with mesh
~={mesh=''} => ~.mesh = '': must be a name
~={mesh=3} => ~.mesh = 3: must be a string, not a whole number
~={mesh='a.msh', width=1} => ~.width: must not be given together with mesh
~={mesh='a.msh', holder={width=1, height=1}} => ~.holder: must not be given together with mesh
~={kind='pad', width=0.0901, height=0.1} => ~.width = 0.0901: must be <= 0.09
~={kind='pad', width=0.08, height=0.02} => ~.height = 0.02: must be > 0.0222222 m, as the face recedes by 0.02 m
bodies=3 => bodies = 3: must be a table, not a whole number
bodies.middle=3 => bodies.middle: unknown key; known are upper, lower
bodies.upper=3 => bodies.upper = 3: must be a table, not a whole number
bodies.upper={pulled=true, support='sides', BLOCK} => bodies.upper.pulled = true: must be false
bodies.upper={kind='pad', BLOCK} & ~={kind='pad', BLOCK} => ~.kind = 'pad': must be 'block'; bodies.upper is a pad
friction={f=[0.6,0.4]} => friction.x: missing; must give the places of the numbers of friction.f
friction={f=0.5,x=[0,1]} => friction.x: must be left out where friction.f is one number
friction={f=[0.6,0.4],x=[1,1]} => friction.x[1] = 1.0: must be > friction.x[0] = 1.0
friction={f=[0.6,0.4],x=[0,1,2]} => friction.x: must have as many numbers as friction.f, 2, not 3
friction={f=[0.6,0],x=[0,1]} => friction.f[1] = 0: must be > 0.0
friction={f=[0.6],x=[0,1]} => friction.f = [0.6]: must be an array of at least 2 numbers
friction={f='x'} => friction.f = 'x': must be a number or an array, not a string
friction={f=-1} => friction.f = -1: must be >= 0.0
material={} => material.E: missing
material={E=1e9} => material.nu: missing
material={nu=0.3} => material.E: missing
material={E=1e9,upper={E=2e11,nu=0.3},lower={E=1e11,nu=0.35}} => material.nu: missing
material={upper={E=2e11,nu=0.3}} => material.lower: missing; or give E and nu in material, for the body without its own
material={lower={E=2e11,nu=0.3}} => material.upper: missing; or give E and nu in material, for the body without its own
material={upper={E=2e11,nu=0.3},lower={E=1e9}} => material.lower.nu: missing
material={upper={E=2e11,nu=0.3},lower={E=-1,nu=0.3}} => material.lower.E = -1: must be > 0
material={E='hard',nu=0.3} => material.E = 'hard': must be a number, not a string
material={E=1e9,nu=0.5} => material.nu = 0.5: must be < 0.5
"""
ROWS = [(f"{first} {row}".partition(" => ")) for first, rows in REFUSED.items() for row in rows.strip("\n").split("\n")]


@pytest.fixture
def files(tmp_path):
    """Files that the commands name."""
    (tmp_path / "bench.toml").write_text(GOOD, "utf-8")
    (tmp_path / "t.csv").write_text(TABLE, "utf-8")
    for name in ("t.frd", "q.frd"):
        (tmp_path / name).write_bytes(FRD.read_bytes())
    (tmp_path / "blocks.toml").write_text(TEXT, "utf-8")
    Path(tmp_path / "file").touch()
    Path(tmp_path / "map.csv").mkdir()


@pytest.mark.usefixtures("files")
@pytest.mark.parametrize(("command", "said"), [(command, said) for command, _, said in ROWS])
def test_commands(rejected, command, said):
    told = rejected(None, shlex.split(command)).removeprefix("partialslip: ")
    assert told.startswith(said) or (said.startswith("...") and said[3:] in told)


@pytest.mark.usefixtures("files")
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([*EXACT, "--out", "nul\0"], r"--out nul\x00: cannot be written"),
        ([*EXACT, "--bo\ngus"], r"unknown argument --bo\ngus (see partialslip run --help)"),
        ([*SHIPPED, "--set", "load.p0=" + "9" * 5000], "999...: not valid TOML: "),
        ([*SHIPPED, "--set", "x\ny=1"], r"x\ny: unknown key"),
        (["run", "hertz-shear", "--with", "march", "--start", "nul\0"], "nul"),
        (["run", "hertz-shear", "--with", "march", "--save", "nul\0.npz"], "cannot be written"),
    ],
)
def test_characters_that_no_shell_would_pass(rejected, arguments, said):
    assert said in rejected(None, arguments)


@pytest.mark.parametrize("row", SETTINGS.strip().splitlines())
def test_settings(rejected, row):
    settings, _, said = row.replace("~", "bodies.lower").replace("BLOCK", "width=0.04, height=0.02").partition(" => ")
    told = rejected(None, [*SHIPPED, *(word for each in settings.split(" & ") for word in ("--set", each))])
    assert told.startswith(f"partialslip: hertz-shear: {said}")
