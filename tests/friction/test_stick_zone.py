"""The stick zone from tangential forces on functions known in closed form, and patterns that are no stick zone."""

import numpy as np
import pytest

from partialslip.friction import zone_ends
from partialslip.friction.zone_ends import read_stick_zone, right_end
from partialslip.march.cells import graded_cells

VERTICES = np.linspace(-1, 1, 81)
X = (VERTICES[1:] + VERTICES[:-1]) / 2
BOUND = np.full(len(X), 0.025)


def room(left, right, depth=1.0):
    """Integrals over the cells of ``depth`` sqrt((right - x)(x - left)), the room 2 f p - |dq| in a stick zone."""
    centre, c = (left + right) / 2, (right - left) / 2
    t = np.clip((VERTICES - centre) / c, -1, 1)
    return np.diff(depth * c**2 / 2 * (t * np.sqrt(1 - t**2) + np.arcsin(t)))


def read(room, signs=(1, 1)):
    turn = np.where(X < 0, *signs)
    return read_stick_zone(X, BOUND, turn * (2 * BOUND - room), VERTICES, lambda forces: forces)


@pytest.mark.parametrize("depth", [1.0, 1e-3, 1e-7])
@pytest.mark.parametrize(("left", "right"), [(-0.31, 0.52), (-0.9, -0.2), (0.013, 0.777)])
def test_ends_are_found_however_little_room_there_is(left, right, depth):
    zone = read(room(left, right, depth))
    assert (zone.left, zone.right) == pytest.approx((left, right), abs=0.025 / 25)
    assert zone.signs == (1, 1)


@pytest.mark.fault
@pytest.mark.parametrize("stray", [-0.9, 0.71, 0.9875])
def test_a_node_short_of_its_bound_elsewhere_is_no_stick_zone(stray, monkeypatch):
    """Deliberate fault: from the first to the last node that sticks, wherever they are."""
    some = room(-0.31, 0.52, 1e-4)
    some[np.abs(X - stray).argmin()] += 1e-8 * BOUND[0]
    zone = read(some)
    assert (zone.left, zone.right) == pytest.approx((-0.31, 0.52), abs=0.025 / 25)
    monkeypatch.setattr(zone_ends, "_around", lambda *args: np.flatnonzero(args[2]))
    wrong = read(some)
    assert max(abs(wrong.left + 0.31), abs(wrong.right - 0.52)) > 0.1


def test_the_end_is_not_where_all_nodes_of_a_cell_slip():
    """Room that does not vanish like a square root: the root of the fit lies two cells beyond the last node."""
    vertices, nodes = np.array([0.0, 0.3, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1]), np.linspace(0, 0.79, 40)
    beyond = np.where(vertices < 0.75, np.maximum(1.05 - vertices, 0) ** 1.5, 0)
    assert 0.79 <= right_end(vertices, -np.diff(beyond), nodes) < 0.9
    sharp = np.maximum(0.83 - vertices, 0) ** 1.5
    assert right_end(vertices, -np.diff(sharp), nodes) == pytest.approx(0.83, abs=1e-9)


def over_cells(vertices, p):
    """Integrals over cells of a pressure ``p`` of phi, x = sin(phi), that vanishes beyond [-1, 1]."""
    t, weights = np.polynomial.legendre.leggauss(60)
    ends = np.arcsin(np.clip(vertices, -1, 1))
    phi = (ends[1:] + ends[:-1])[:, None] / 2 + np.diff(ends)[:, None] / 2 * t
    return np.diff(ends) / 2 * ((p(phi) * np.cos(phi)) @ weights)


def read_beside(kink, size, growth, offset):
    """Stick zone [-1, 1] whose room is the pressure of half-planes under a flat-rounded punch with kinks at +-``kink``
    (Ciavarella, Hills and Monno 1998), on cells graded to the kinks and to points ``offset`` cells beyond its ends."""
    end = 1 + offset * size
    vertices = graded_cells(np.array([-1.3, -end, -kink, kink, end, 1.3]), size, growth)
    psi = np.arcsin(kink)

    def p(phi):
        smooth = (np.pi - 2 * psi) * np.cos(phi) + np.sin(phi) * np.log(np.abs(np.sin(phi + psi) / np.sin(phi - psi)))
        return smooth + kink * np.log(np.abs(np.tan((phi + psi) / 2) * np.tan((phi - psi) / 2)))

    room = over_cells(vertices, p)
    bound = np.full(len(room), room.max())
    return read_stick_zone((vertices[1:] + vertices[:-1]) / 2, bound, 2 * bound - room, vertices, lambda forces: forces)


@pytest.mark.fault
@pytest.mark.parametrize(("size", "growth"), [(3e-3, 0.35), (6e-4, 0.7)])
@pytest.mark.parametrize("kink", [0.9, 0.95])
def test_a_kink_of_the_profile_that_the_fit_reaches_is_seen(kink, size, growth, monkeypatch):
    """Deliberate fault: the second fit is as long as the first."""

    def zones():
        return [read_beside(kink, size, growth, offset) for offset in (-0.45, -0.2, 0.1, 0.3)]

    errors = [abs(zone.right - 1) for zone in zones()]
    assert max(errors) > 8e-3 * size
    assert all(error < 1.6 * zone.fits[1] for error, zone in zip(errors, zones(), strict=True))
    monkeypatch.setattr(zone_ends, "NEAREST", zone_ends.VERTICES)
    assert all(zone.fits == (0, 0) for zone in zones())


def test_without_a_kink_long_and_short_fits_agree():
    zone = read_beside(1e-6, 3e-3, 0.35, 0.3)
    assert max(zone.fits) < 3e-4 * 3e-3


# p of half-planes whose gap is like x^power, over sqrt(1 - x^2)
_FLAT_BOTTOMS = {2: lambda x: 1 + 0 * x, 4: lambda x: 1 + 2 * x**2, 6: lambda x: 3 + 4 * x**2 + 8 * x**4}


@pytest.mark.fault
@pytest.mark.parametrize(("power", "least", "most"), [(2, 0.0, 3e-4), (4, 2e-3, 5e-3), (6, 1e-2, 2e-2)])
@pytest.mark.parametrize("offset", [0.0, 0.1, 0.5])
def test_an_end_of_a_contact_with_a_flat_bottom_is_seen_to_be_unsure(power, least, most, offset):
    """p of Hertz is nearly the square root that the fit takes it for; under x^6, on cells twice as wide each, the end
    is off by a hundredth of a cell. The shorter fit tells it. Deliberate fault: it is as long as the first."""
    size = 2.4e-3
    reach = size * (2.0 ** np.arange(9) - 1) - offset * size
    vertices = np.concatenate([[-1 - size], reach - 1, 1 - reach[::-1], [1 + size]])
    normal = over_cells(vertices, lambda phi: np.cos(phi) * _FLAT_BOTTOMS[power](np.sin(phi)))
    inside = np.sort([*vertices[np.abs(vertices) < 1], *np.linspace(-1, 1, 4001)[1:-1]])

    def right(count):
        return zone_ends.contact_ends(vertices, normal, inside, count=count)[1]

    many, few = right(zone_ends.VERTICES), right(zone_ends.NEAREST)
    assert least * size <= abs(many - 1) <= most * size
    assert abs(many - 1) < 1.5 * abs(many - few)
    assert abs(many - 1) > 1.5 * abs(many - right(zone_ends.VERTICES))


def test_a_zone_smaller_than_a_cell_is_where_the_slip_turns_round():
    zone = read(0 * X, signs=(-1, 1))
    assert zone.left == zone.right == pytest.approx(0, abs=0.025)
    assert zone.signs == (-1, 1)


@pytest.mark.parametrize("side", [-1, 1])
def test_a_zone_at_the_end_of_the_line(side):
    """The first mesh may be too short for the contact: a stick zone at the end of the mesh is found."""
    zone = read(room(*sorted((side * 1.2, side * 0.4))))
    assert side * (zone.right if side > 0 else zone.left) == pytest.approx(1, abs=0.05)
    assert side * (zone.left if side > 0 else zone.right) == pytest.approx(0.4, abs=0.025 / 25)


def test_kinks_are_where_q_leaves_its_bound():
    """A first loading and a reversal lock in two zones, one within the other: both ends of each, far below a cell."""
    inner, outer = room(-0.31, 0.52), room(-0.6, 0.8)
    for q, expected in ((BOUND - inner, (-0.31, 0.52)), (outer - BOUND, (-0.6, 0.8))):
        found = zone_ends.kinks(X, BOUND, q, VERTICES, lambda forces: forces)
        assert found == pytest.approx(expected, abs=0.025 / 25)


def test_kinks_between_slip_of_either_way():
    """Large tension: the bound is met with one sign on the left and with the other on the right."""
    zone = room(-0.31, 0.52)
    turn = np.where(X < 0, -1, 1)
    assert zone_ends.kinks(X, BOUND, turn * (BOUND - zone), VERTICES, lambda forces: forces) == pytest.approx(
        [-0.31, 0.52], abs=0.025 / 25
    )


def test_the_finest_places_of_a_mesh():
    points = np.array([-1.0, -0.3, 0.41, 1.0])
    assert zone_ends.finest(graded_cells(points, 1e-4, 0.1)) == [-0.3, 0.41]
    assert zone_ends.finest(np.linspace(-1, 1, 50)) == []


@pytest.mark.parametrize("count", [0, 1, 3])
def test_an_end_that_passed_few_nodes_is_unsure_by_what_it_passed(count):
    """Too few nodes tell that the end moved outwards; the strip over which they slipped does."""
    some = room(-0.31, 0.52)
    inside = np.flatnonzero(some > 0)
    changed = np.full(len(X), np.nan)
    changed[inside[:count]] = 0.5
    zone = read_stick_zone(X, BOUND, 2 * BOUND - some, VERTICES, lambda forces: forces, changed)
    assert zone.moved == (False, False)
    assert zone.strips == pytest.approx((count * 0.025, 0.0), abs=1e-12)


@pytest.mark.parametrize("power", [0.5, 1.5])
def test_an_end_beside_which_room_does_not_grow_is_unsure_by_that_strip(power):
    """Nodes that have all but stopped to slip have the same room, 1e-7 of the bound: whether they stick nothing tells.
    Room that begins with a power of the distance makes no strip, be it as small."""
    some = BOUND * 1e-6 * np.clip((0.52 - X) / 0.5, 0, 1) ** power * np.clip((X + 0.31) / 0.5, 0, 1) ** power
    faint = np.where((X > 0.5) & (X < 0.95), 1e-8 * BOUND, some)
    for of, strip in ((some, 0.0), (faint, 0.45)):
        zone = read_stick_zone(X, BOUND, 2 * BOUND - of, VERTICES, lambda forces: forces, np.full(len(X), 0.5))
        assert zone.strips[1] == pytest.approx(strip, abs=0.05)


def test_an_end_in_a_narrow_strip_lies_between_the_nodes_that_stick_and_slip():
    """A fit reaches across the kink of q at the inner side of the strip over which nodes slipped before."""
    some = room(-0.31, 0.4)
    strip = (X > 0.4) & (X < 0.52)
    some[strip] = 0.01 * BOUND[0]
    changed = np.where(X > 0.4, 0.5, np.nan)
    zone = read_stick_zone(X, BOUND, 2 * BOUND - some, VERTICES, lambda forces: forces, changed)
    assert zone.right == pytest.approx(0.525, abs=1e-12)
    assert zone.strips == pytest.approx((0.0, 0.025), abs=1e-12)


@pytest.mark.parametrize("hardly", [0, 2])
def test_an_end_that_came_back_between_two_nodes_lies_between_them(hardly):
    """The first node beyond the end had stuck again before: the end turned round beside it. The kink of q where it did
    so is nearer than the nodes tell. The nodes beyond may ``hardly`` slip any more."""
    some = room(-0.31, 0.52)
    changed, stuck = np.where(some > 0, np.nan, 0.9), np.full(len(X), np.nan)
    changed[np.flatnonzero(X > 0.525)[:hardly]] = np.nan
    before = read_stick_zone(X, BOUND, 2 * BOUND - some, VERTICES, lambda forces: forces, changed, None, stuck)
    assert before.strips == (0.0, 0.0)
    stuck[X > 0.525] = 0.5
    zone = read_stick_zone(X, BOUND, 2 * BOUND - some, VERTICES, lambda forces: forces, changed, None, stuck)
    assert zone.right == pytest.approx(0.525, abs=1e-12)
    assert zone.strips == pytest.approx((0.0, 0.025), abs=1e-12)
    assert zone.left == before.left


@pytest.mark.fault
def test_a_fit_does_not_reach_across_the_place_where_an_end_turned_round(monkeypatch):
    """Five vertices beside the end are those of the strip over which nodes slipped before; q has a kink at the other
    side of it. Deliberate fault: which nodes slipped is not looked at."""
    true = 0.5237
    some = room(-0.31, true)
    some[VERTICES[1:] < 0.376] *= 0.8
    at = np.sqrt(np.clip((true - VERTICES) * (VERTICES + 0.31), 0, None))
    at[VERTICES < 0.374] *= 0.8
    changed = np.where(true > VERTICES, np.where(VERTICES > 0.374, 0.5, np.nan), 0.99)
    given = VERTICES, np.ones(len(VERTICES)), 2 - at, VERTICES, lambda _: some, changed
    assert read_stick_zone(*given).right == pytest.approx(true, abs=0.025 / 50)
    monkeypatch.setattr(zone_ends, "_slipped", lambda *_: 0)
    assert abs(read_stick_zone(*given).right - true) > 0.025 / 10


@pytest.mark.fault
def test_an_end_beside_nodes_with_unsteady_room_has_moved_outwards(monkeypatch):
    """Under mean loads nodes beyond the end stick again, later than those within it, with room that is to vanish.
    Deliberate fault: the last node that stuck again counts as one that slips on."""
    distance = np.clip(0.52 - VERTICES, 0, None) * (VERTICES > -0.31)
    some = -np.diff(distance**2.5)
    some[X < -0.3] = 0
    spread = np.where((X > 0.52) & (X < 0.6), 1e-7 * BOUND, 0.0)
    changed = np.where(X > -0.31, np.clip(1 - (0.6 - X) / 2, None, 1.0), 0.0)

    def read_again():
        found = some + spread
        unsteady = np.where(X > 0.52, 2 * found, 0.0)
        return read_stick_zone(X, BOUND, 2 * BOUND - found, VERTICES, lambda forces: forces, changed, unsteady)

    zone = read_again()
    assert zone.moved[1]
    assert zone.right == pytest.approx(0.52, abs=0.025 / 25)
    assert zone.strips[1] == pytest.approx(0.6 - zone.right, abs=1e-9)  # where the nodes say that it is
    power = zone_ends._power
    monkeypatch.setattr(zone_ends, "_power", lambda changed, still, *nodes: power(changed, 0 * still, *nodes))
    wrong = read_again()
    assert not wrong.moved[1]
    assert abs(wrong.right - 0.52) > 0.01


@pytest.mark.parametrize("together", [1, 6])
def test_an_end_beside_nodes_that_stuck_at_once_is_where_the_loads_tell(together):
    """The room ends at 0.507. Nodes further in tell by when they stuck that the end has come to 0.52; the last ones
    stuck ``together``."""
    some = -np.diff(np.clip(0.507 - VERTICES, 0, None) ** 2.5 * (VERTICES > -0.31))
    inside = np.flatnonzero(some > 0)
    changed = np.full(len(X), 0.2)
    changed[inside] = 1 - (0.52 - X[inside]) / 2
    changed[inside[-together:]] = changed[inside[-together:]].mean()
    zone = read_stick_zone(X, BOUND, 2 * BOUND - some, VERTICES, lambda forces: forces, changed)
    assert zone.moved[1]
    if together == 1:
        assert zone.right == pytest.approx(0.507, abs=2e-3)
        assert zone.strips[1] == 0
    else:
        assert zone.right == zone.caught[1]
        assert zone.right == pytest.approx(0.52, abs=0.02)
        assert zone.strips[1] == pytest.approx(zone.right - 0.507, abs=2e-3)
