"use strict";

// The steady state of Hertz's contact, in plain JavaScript: docs/theory.md, sections 4 to 7. Lengths are scaled by a,
// pressures by p0, loads by friction: Qf = dQ/(2 f P) and sf = dsigma/(f p0), both >= 0. A stick zone [-m, n] is stored
// as in Python: centre (n - m)/2, half-width c = (n + m)/2, and s, +1 where both ends slip in the same direction.
const hertz = (() => {
  const NARROWEST = 1e-100;  // smallest half-width of a stick zone
  const NARROW = 1e-5;
  const CLOSE = 1e-9;  // converged after a Newton step as small as this: the error is then rounding
  const SETTLED = 1e-13;
  const ROUNDING = 4 * Number.EPSILON;
  const STEPS = 40;
  const STAGES = 48;  // of the way between the load points

  // Nodes in (-1, 1), their distances from 1, and weights of the tanh-sinh rule.
  const RULE = Array.from({ length: 81 }, (_, i) => {
    const k = -3.2 + 0.08 * i, u = Math.PI / 2 * Math.sinh(k);
    const weight = 0.08 * Math.PI / 2 * Math.cosh(k) / Math.cosh(u) ** 2;
    return { node: Math.tanh(u), toEnd: 2 / (1 + Math.exp(2 * u)), weight };
  });

  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
  const pressure = (x) => Math.sqrt(Math.max((1 - x) * (1 + x), 0));

  // Bulirsch's complete elliptic integral (1969) for positive p: integral from 0 to pi/2 of
  // (a cos^2 + b sin^2)/((cos^2 + p sin^2) sqrt(cos^2 + k^2 sin^2)), with the complementary modulus k.
  function elliptic(k, p, a, b) {
    let root = Math.sqrt(p), product = k, mean = 1;
    b /= root;
    for (;;) {
      const before = a, ratio = product / root, last = mean;
      a += b / root;
      b = 2 * (b + before * ratio);
      root += ratio;
      mean += k;
      if (!(Math.abs(last - k) > 1e-9 * last)) return Math.PI / 2 * (b + a * mean) / (mean * (mean + root));
      k = 2 * Math.sqrt(product);
      product = k * mean;
    }
  }

  // Loads of a stick zone at the distance `edge` = 1 - m from the contact's left end, and the stiffness of its ends,
  // without cancellation (eqs. (21), (22) and (24)-(26); X = K - Pi((m-1)/(m+1))).
  function conditions(edge, c, s) {
    if (s > 0) return { sf: 8 * (1 - c - edge), Qf: (1 - c) * (1 + c), right: c, left: c, skew: 0 };
    const centre = edge + c - 1, fromLeft = edge + 2 * c;  // 1 + n
    const square = (2 - edge) * fromLeft, root = Math.sqrt(square), k = 2 * Math.sqrt(c / square);
    const K = elliptic(k, 1, 1, 1), E = elliptic(k, 1, 1, k * k);
    const X = edge / (2 - edge) * elliptic(k, 2 / (2 - edge), 0, 1);
    const first = -2 * root * E + (4 * fromLeft * K - 8 * centre * X) / root - Math.PI * centre;
    const second = -centre * root * E
      + (1 - c) * ((4 * (1 + c) * X - 2 * fromLeft * K) / root + Math.PI / 2 * (1 + c));
    const right = c + 2 / Math.PI * (root * E - 4 * c * (K - X) / root);
    const skew = 2 + 8 * (2 * X - K) / (Math.PI * root);
    return { sf: 8 / Math.PI * first, Qf: 2 / Math.PI * second, right, left: right - c * skew, skew };
  }

  // The stick zone for 0 <= Qf < 1 and sf >= 0: in closed form for small tension, else by Newton's method in s * edge,
  // which is smooth across the transition, and log c (section 6). `steps` counts the Newton steps.
  function stickZone(Qf, sf) {
    sf = Math.min(sf, 1e5);  // larger values give the smallest half-width
    let c = Math.sqrt(1 - Qf), edge = Qf / (1 + c) - sf / 8, steps = 0;
    if (edge < 0) [edge, c] = late(Qf, edge, c);
    else return { centre: edge + c - 1, c, s: 1, steps };
    for (; steps < STEPS; steps++) {
      const at = conditions(Math.abs(edge), c, edge < 0 ? -1 : 1);
      const dQf = Qf - at.Qf, dsf = sf - at.sf;
      const toEdge = (dQf / 2 - c * dsf / 8) / at.left, toN = -(dQf / 2 + c * dsf / 8) / at.right;
      let grow = edge < 0 ? (dQf / 4 * at.skew - dsf / 16 * (at.right + at.left)) / (at.right * at.left)
        : (toN - toEdge) / (2 * c);
      if (c <= NARROWEST && grow < 0) grow = 0;
      const width = c;
      c = Math.max(Math.min(c * Math.exp(clamp(grow, Math.log(c) / 2 - 1, 1)), (1 + c) / 2), NARROWEST);
      edge = clamp(edge + toEdge, c - 1, 1 - c);
      const step = Math.max(Math.abs(toEdge), Math.abs(grow));
      if (step < CLOSE * (2 - 2 * width) + ROUNDING && (width > NARROW || Math.abs(dQf) <= SETTLED)) break;
      if (Math.abs(dQf) <= ROUNDING && Math.abs(dsf) <= ROUNDING * Math.max(sf, 8)) break;
    }
    return { centre: Math.abs(edge) + c - 1, c, s: edge < 0 ? -1 : 1, steps };
  }

  // Initial guess for large tension, from s * edge and c of small tension: between the transition and the limit of a
  // narrow stick zone (section 5).
  function late(Qf, edge, c) {
    const y = Math.PI / 2 * Qf;
    let b = y / 2;  // b + sin(b) cos(b) = y is the condition on dQ; -sin(b) is the centre
    for (let i = 0; i < 3; i++) {
      b = clamp(b - (b + Math.sin(2 * b) / 2 - y) / (1 + Math.cos(2 * b) + 1e-9), 0, Math.PI / 2);
    }
    const decay = Math.exp(Math.max(Math.PI * edge / (2 * Math.max(Math.cos(b), 1e-3)), -230));
    const centre = -Math.sin(b) + (c - 1 + Math.sin(b)) * decay;
    const width = c * decay;
    return [-clamp(1 + centre - width, 1e-6 * (1 - width), 1 - width), width];
  }

  // dsigma/(f p0) at which small tension ends, eq. (23).
  const transition = (Qf) => 8 * Qf / (1 + Math.sqrt(1 - Qf));

  // Points and weights in the slip zone on one side (1 right, -1 left): the integral of g/w is the sum of weight g(t),
  // t = centre +- c cosh(theta); double exponential at the square root at the contact's end.
  function slipRule(gap, zone, side) {
    const end = 2 * Math.asinh(Math.sqrt(gap / (2 * zone.c))), middle = Math.max(end - 3, 0);
    return [[0, middle], [middle, end]].filter(([low, high]) => high > low).flatMap(([low, high]) =>
      RULE.map(({ node, toEnd, weight }) => {
        const half = (high - low) / 2, theta = node < 0 ? low + half * (1 + node) : high - half * toEnd;
        return { t: clamp(zone.centre + side * zone.c * Math.cosh(theta), -1, 1), weight: half * weight };
      }));
  }

  // dq/(2 f p0) in the stick zone, as a function of the distance from the centre of the zone (section 4).
  function insideOf(zone) {
    const edge = Math.max(1 + zone.centre - zone.c, 0);
    const sides = [[1, 1, Math.max(2 - edge - 2 * zone.c, 0)], [-1, zone.s, edge]].map(([side, sign, gap]) => {
      const rule = slipRule(gap, zone, side).map(({ t, weight }) => ({ t, p: pressure(t), weight }));
      return { side, sign, rule, tangent: Math.sqrt(gap / (gap + 2 * zone.c)) };
    });
    return (offset) => {
      const x = zone.centre + offset, p = pressure(x);
      const toLeft = Math.sqrt(Math.max(zone.c + offset, 0)), toRight = Math.sqrt(Math.max(zone.c - offset, 0));
      let arcs = 0, smooth = 0;
      for (const { side, sign, rule, tangent } of sides) {
        arcs += sign * 2 * (side > 0 ? Math.atan2(tangent * toLeft, toRight) : Math.atan2(tangent * toRight, toLeft));
        // the quotient (p(t) - p(x))/(t - x)
        for (const { t, p: there, weight } of rule) {
          if (there + p > 0) smooth -= side * sign * weight * (t + x) / (there + p);
        }
      }
      return (p * arcs + toLeft * toRight * smooth) / Math.PI;
    };
  }

  // x, p/p0 and dq/(2 f p0) over the contact, denser at the ends of the zones.
  function tractions(zone, count = 80) {
    const inside = insideOf(zone), crowd = Array.from({ length: count + 1 }, (_, i) => -Math.cos(Math.PI * i / count));
    const left = zone.centre - zone.c, right = zone.centre + zone.c;
    const slip = (low, high, sign) => (high <= low ? [] : crowd.map((way) => {
      const x = (low + high) / 2 + (high - low) / 2 * way;
      return { x, p: pressure(x), q: sign * pressure(x) };
    }));
    const stick = crowd.map((way) => {
      const x = zone.centre + zone.c * way;
      return { x, p: pressure(x), q: inside(zone.c * way) };
    });
    return [...slip(-1, left, zone.s), ...stick, ...slip(right, 1, 1)];
  }

  // The largest |q| = |dq|/2, in f p0: at an end of the stick zone, or in the middle of the contact if slipping there.
  function largest({ centre, c }) {
    const ends = [centre - c, centre + c].map(Math.abs);
    return Math.abs(centre) >= c ? 1 : pressure(Math.min(...ends));
  }

  // Sum of coefficients times Chebyshev polynomials at x, from -1 to 1.
  function series(coefficients, x) {
    let one = 0, two = 0;
    for (let i = coefficients.length - 1; i > 0; i--) [one, two] = [coefficients[i] + 2 * x * one - two, one];
    return (coefficients[0] ?? 0) + x * one - two;
  }

  // The stick zone under gradual loads where slip turns round, from the `table` of gradual_table.py; null where it has
  // none. One step holds again where all points that slipped the other way slip once more.
  function gradualZone(table, once, Qf, sf) {
    if (once.s > 0 && sf * (1 - (once.centre - once.c)) <= 8 * Qf) return once;
    const w = Math.sqrt(1 - Qf);
    for (const { low, high, borders, patches, signs } of table.panels) {
      if (sf < low || sf > high) continue;
      const along = 2 * (sf - low) / (high - low) - 1, at = borders.map((border) => series(border, along));
      for (const [i, ends] of patches.entries()) {
        const share = (at[i] - w) / (at[i] - at[i + 1]);
        if (share < -1e-6 || share > 1 + 1e-6) continue;
        const across = clamp(2 * share - 1, -1, 1);
        const [left, right] = ends.map((rows) => series(rows.map((row) => series(row, across)), along));
        return { centre: (left + right) / 2, c: (right - left) / 2, s: signs[i], steps: 0 };
      }
    }
    return null;
  }

  // Whether slip reverses on the straight way between the load points (section 7).
  function reverses({ centre, c, s }, Qf, sf) {
    if (sf === 0) return false;
    return s > 0 ? sf > 4 * Qf : c * sf < 4 * Qf || Math.abs(-4 * Qf / sf - centre) > c;
  }

  // The largest |Q_mean|/(f P) of a steady state (section 7): the resultant of f p less |dq|/2, and less what the way
  // between the load points takes.
  function meanLoadBound(zone, Qf, sf) {
    if (zone.s > 0) return 1 - Qf;
    const inside = insideOf(zone), at = (angle) => inside(zone.c * Math.cos(angle));
    let low = 0, high = Math.PI;  // dq changes sign between n and -m
    for (let i = 0; i < 60; i++) {
      const middle = (low + high) / 2;
      if (at(middle) > 0) low = middle; else high = middle;
    }
    let room = 0;
    for (const [from, to] of [[0, low], [low, Math.PI]]) {
      for (const { node, weight } of RULE) {
        const angle = (from + to) / 2 + (to - from) / 2 * node, sine = Math.sin(angle);
        const free = pressure(zone.centre + zone.c * Math.cos(angle)) - Math.abs(at(angle));
        room += (to - from) / 2 * weight * sine * free;
      }
    }
    const between = reverses(zone, Qf, sf) ? 0 : takenBetween(zone, Qf, sf, inside, zone.centre + zone.c * Math.cos(low));
    return 2 / Math.PI * (zone.c * room - between);
  }

  // The integral of max |dq_t - dq/2| - |dq|/2 over the points at which dq_t, the change on the way so far, has an
  // extreme: where the adhered traction of the stick zone of a stage changes its sign. `turn`: where dq changes sign.
  function takenBetween(zone, Qf, sf, inside, turn) {
    const stages = Array.from({ length: STAGES + 1 }, (_, i) => {
      return (i ? stickZone(i / STAGES * Qf, i / STAGES * sf).centre : 0) - 4 * Qf / sf;
    });
    const low = zone.centre - 4 * Qf / sf, high = -4 * Qf / sf, places = [low, clamp(turn, low, high), high];
    let taken = 0;
    for (const [from, to] of [places.slice(0, 2), places.slice(1)].filter((ends) => ends[1] - ends[0] > SETTLED)) {
      for (const { node, weight } of RULE) {
        const x = (from + to) / 2 + (to - from) / 2 * node;
        const next = clamp(stages.findIndex((place) => place <= x), 1, STAGES), after = stages[next];
        const share = (next - (x - after) / (stages[next - 1] - after)) / STAGES;
        const stage = stickZone(share * Qf, share * sf), final = inside(x - zone.centre);
        const extreme = insideOf(stage)(x - stage.centre);
        taken += (to - from) / 2 * weight * (Math.abs(2 * extreme - final) - Math.abs(final));
      }
    }
    return taken;
  }

  return { gradualZone, largest, meanLoadBound, pressure, reverses, stickZone, tractions, transition };
})();
