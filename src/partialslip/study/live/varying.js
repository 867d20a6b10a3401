"use strict";

// The steady state where P and its line of action x = e differ between the load points: docs/theory.md. A contact is
// {a, e}: p = sqrt(a^2 - (x - e)^2), scaled as in hertz.js by a and p0 of one load point. `contacts` has the contacts
// at load points 1 and 2. All formulas hold with the mean of both pressures and are linear in the pressure. The loads
// of a stick zone, and q, are therefore the means over the two contacts, each in its own scale, with one stick zone.
const varying = (() => {
  const STEPS = 60, HALVINGS = 50, SAMPLES = 64, STAGES = 16, PLACES = 96;
  const NARROWEST = 1e-100, ROUNDING = 1e-12;
  const CLOSE = 1e-15;  // smallest distance of a narrow stick zone from the right end of a contact

  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
  const mean = (contacts, of) => (of(contacts[0]) + of(contacts[1])) / 2;
  const pressureOf = ({ a, e }, x) => Math.sqrt(Math.max((a - x + e) * (a + x - e), 0));
  const pressure = (contacts, x) => mean(contacts, (contact) => pressureOf(contact, x));
  const common = ([one, two]) => [Math.max(one.e - one.a, two.e - two.a), Math.min(one.e + one.a, two.e + two.a)];
  const union = ([one, two]) => [Math.min(one.e - one.a, two.e - two.a), Math.max(one.e + one.a, two.e + two.a)];

  const ends = ({ centre, c }) => [centre - c, centre + c];

  // Loads of a stick zone for large tension, and the stiffness of its ends.
  function conditions(contacts, left, c) {
    const found = contacts.map(({ a, e }) => {
      const width = Math.min(c / a, 1), edge = clamp((left - e) / a + 1, 0, 2 - 2 * width - (width < CLOSE ? CLOSE : 0));
      return hertz.conditions(edge, width, -1);
    });
    const sum = (key, power) => contacts.reduce((total, { a }, i) => total + found[i][key] * a ** power / 2, 0);
    return { Qf: sum("Qf", 2), sf: sum("sf", 1), right: sum("right", 1), left: sum("left", 1), skew: sum("skew", 0) };
  }

  // The stick zone at which large tension begins for this Qf, and its sf; null if no stick zone has this Qf. One of its
  // ends is an end of the common contact: of all these zones, from nothing at the left end over the common contact to
  // nothing at the right end, Qf decreases.
  function beginning(contacts, Qf) {
    const [low, high] = common(contacts), width = high - low;
    if (!(width > 0)) return null;
    const zone = (way) => ({ left: low + Math.max(way - 1, 0) * width, c: Math.min(way, 2 - way) * width / 2 });
    const [from, to] = halved(0, 2, HALVINGS, (way) => conditions(contacts, zone(way).left, zone(way).c).Qf > Qf);
    const start = zone((from + to) / 2), at = conditions(contacts, start.left, start.c);
    return Math.abs(at.Qf - Qf) < 1e-9 ? { ...start, sf: at.sf } : null;
  }

  // The stick zone for Qf >= 0 and sf >= 0 if both ends slip, else null: in closed form for small tension, else by
  // Newton's method in the left end and log c. Its ends lie inside both contacts.
  function stickZone(contacts, Qf, sf) {
    const [low, high] = common(contacts);
    if (!(low < high)) return null;
    const zone = alike(contacts, Qf, sf), [left, right] = ends(zone);
    if (zone.c > 0 && left >= low - ROUNDING && right <= high + ROUNDING) return zone;
    const start = beginning(contacts, Qf);
    return start && sf >= start.sf - ROUNDING ? opposite(contacts, Qf, Math.min(sf, 1e5), start) : null;
  }

  // Small tension in closed form; the half-width is NaN if there is no stick zone.
  function alike(contacts, Qf, sf) {
    const c = Math.sqrt(mean(contacts, ({ a }) => a * a) - Qf);
    return { centre: mean(contacts, ({ e }) => e) - sf / 8, c, s: 1, steps: 0 };
  }

  // Large tension by Newton's method; `start` is the stick zone at which it begins.
  function opposite(contacts, Qf, sf, start) {
    const [low, high] = common(contacts), widest = (high - low) / 2;
    let { left, c } = guess(contacts, Qf, sf, start), steps = 0, last = Infinity;
    for (; steps < STEPS; steps++) {
      const at = conditions(contacts, left, c), dQf = Qf - at.Qf, dsf = sf - at.sf;
      const move = (c * dsf / 8 - dQf / 2) / at.left;
      const grow = (dQf / 4 * at.skew - dsf / 16 * (at.right + at.left)) / (at.right * at.left);
      const width = c;
      c = clamp(c * Math.exp(clamp(grow, -1, 1)), NARROWEST, widest);
      left = clamp(left + move, low, high - 2 * c);
      const step = Math.max(Math.abs(move), Math.abs(Math.log(c / width)));
      if (step < 1e-15 || (step < 1e-11 && step >= last)) break;  // the steps are rounding
      last = step;
    }
    return { centre: left + c, c, s: -1, steps };
  }

  // Initial guess, with c to a factor of about 2. Where Qf stays the same, a higher tension narrows the zone; where c
  // stays the same, Qf decreases as the zone moves to the right.
  function guess(contacts, Qf, sf, start) {
    const [low, high] = common(contacts);
    const placed = (c) => {
      const [left] = halved(low, high - 2 * c, 40, (x) => conditions(contacts, x, c).Qf > Qf);
      return { left, c };
    };
    const tighter = (exponent) => {
      const { left, c } = placed(start.c * Math.exp(exponent));
      return conditions(contacts, left, c).sf > sf;
    };
    const narrowest = Math.log(NARROWEST / start.c);
    return tighter(narrowest) ? placed(start.c * Math.exp(halved(narrowest, 0, 8, tighter)[1])) : placed(NARROWEST);
  }

  // The interval [low, high] halved `times` times about the end of the range in which `before` is true.
  function halved(low, high, times, before) {
    for (let i = 0; i < times; i++) {
      const middle = (low + high) / 2;
      if (before(middle)) low = middle; else high = middle;
    }
    return [low, high];
  }

  // Rates of the singularities of q (over f) and of p at the left and the right end, where the whole contact sticks, at
  // a share of the way from load point 1 to 2. An end sticks while that of q is not larger than that of p.
  function rates([one, two], Qf, sf, share) {
    const force = two.a ** 2 - one.a ** 2, moment = two.a ** 2 * two.e - one.a ** 2 * one.e;
    const square = one.a ** 2 + share * force, a = Math.sqrt(square);
    const shift = moment - (one.a ** 2 * one.e + share * moment) / square * force;  // a^2 de
    return [-1, 1].map((side) => ({ q: Qf + side * a * sf / 4, p: force / 2 + side * shift / a }));
  }

  // Whether the left and the right end stick: "never", "always", or "partly", during part of the way.
  function sticking(contacts, Qf, sf) {
    const along = Array.from({ length: SAMPLES + 1 }, (_, i) => rates(contacts, Qf, sf, i / SAMPLES));
    return [0, 1].map((side) => {
      const count = along.filter((at) => Math.abs(at[side].q) <= Math.abs(at[side].p) + ROUNDING).length;
      return count > SAMPLES ? "always" : count ? "partly" : "never";
    });
  }

  // dq/(2 f p0) as a function of x if neither end slips; null if it has no formula (dP = 0, or the contact moves).
  function adhered(contacts, Qf, sf) {
    const [one, two] = contacts, force = two.a ** 2 - one.a ** 2;
    if (Qf === 0 && sf === 0) return () => 0;
    if (force === 0 || Math.abs(two.e - one.e) > ROUNDING) return null;
    return (x) => (Qf + (x - one.e) * sf / 4) / force * (pressureOf(two, x) - pressureOf(one, x));
  }

  // dq/(2 f p0) as a function of x in the stick zone if both ends slip.
  function inside(contacts, { centre, c, s }) {
    if (s > 0) return (x) => pressure(contacts, x) - Math.sqrt(Math.max((c - x + centre) * (c + x - centre), 0));
    const parts = contacts.map(({ a, e }) => ({ a, of: hertz.insideOf({ centre: (centre - e) / a, c: c / a, s }) }));
    return (x) => mean(parts, ({ a, of }) => a * of((x - centre) / a));
  }

  // Half-change of q over the union of the contacts. `zone` is null if the whole contact sticks, with q of `stuck`.
  function halfChange(contacts, zone, stuck) {
    if (!zone) return stuck;
    const within = inside(contacts, zone), [low, high] = ends(zone);
    return (x) => (x > low && x < high ? within(x) : pressure(contacts, x) * (x > low ? 1 : zone.s));
  }

  // Points x over the union of the contacts, denser at the ends of the zones and of the contacts.
  function grid(contacts, zone, count = 60) {
    const all = [...union(contacts), ...common(contacts), ...(zone ? ends(zone) : [])].sort((one, two) => one - two);
    return all.slice(1).flatMap((high, i) => (high === all[i] ? [] : Array.from({ length: count + 1 }, (_, k) => {
      const share = (1 - Math.cos(Math.PI * k / count)) / 2;
      return k === count ? high : all[i] + (high - all[i]) * share;
    })));
  }

  // The largest |q|, refined between the neighbours of the largest of the points `xs`.
  function largest(xs, q) {
    const sizes = xs.map((x) => Math.abs(q(x))), best = sizes.indexOf(Math.max(...sizes));
    let low = xs[Math.max(best - 1, 0)], high = xs[Math.min(best + 1, xs.length - 1)];
    for (let i = 0; i < 80; i++) {
      const third = (high - low) / 3, [one, two] = [low + third, high - third];
      if (Math.abs(q(one)) < Math.abs(q(two))) low = one; else high = two;
    }
    return Math.max(sizes[best], Math.abs(q((low + high) / 2)));
  }

  // Resultant of a contact's pressure to the right of x.
  function force({ a, e }, x) {
    const angle = Math.acos(clamp((x - e) / a, -1, 1));
    return a * a / 2 * (angle - Math.sin(2 * angle) / 2);
  }

  // Smallest and largest mean of Q of a steady state, in units of f P of the half-width 1: q1 and q2 must be within
  // their bounds, and are on them in the slip zones.
  function meanLoads(contacts, zone, Qf, sf, q) {
    const [one, two] = contacts, [low, high] = zone ? ends(zone) : common(contacts);
    const slip = zone ? -force(one, high) - zone.s * (force(one, -Infinity) - force(one, low)) : 0;
    const between = zone && !reverses(contacts, Qf, sf, zone.s) ? takenBetween(contacts, zone, Qf, sf, q) : [0, 0];
    const [least, most] = [-1, 1].map((side, i) => {
      const at = (angle) => (low + high) / 2 + (high - low) / 2 * Math.cos(angle);
      const spare = (angle) => pressureOf(two, at(angle)) - side * 2 * q(at(angle));
      return slip - side * between[i] + side * integral((angle) => Math.sin(angle) * Math.min(pressureOf(one, at(angle)), spare(angle)),
        turns((angle) => pressureOf(one, at(angle)) - spare(angle))) * (high - low) / 2;
    });
    return [least, most].map((Q) => 2 / Math.PI * Q + Qf);
  }

  // What stages of the ways between the load points take of the smallest and of the largest mean: q keeps its bound there,
  // too. Midpoint rule; the tightest of all stages by the parabola through it and its neighbours.
  function takenBetween(contacts, zone, Qf, sf, q) {
    const [one, two] = contacts;
    const stages = [[one, two], [two, one]].map(([from, to]) => Array.from({ length: STAGES - 1 }, (_, i) => {
      const share = (i + 1) / STAGES, now = between(from, to, share), found = stickZone([from, now], share * Qf, share * sf);
      return { now, change: found && halfChange([from, now], found) };
    }));
    if (stages.flat().some(({ change }) => !change)) return [0, 0];
    const taken = [0, 0];
    for (let k = 0; k < PLACES; k++) {
      const angle = Math.PI * (k + 0.5) / PLACES, x = zone.centre + zone.c * Math.cos(angle), dq = 2 * q(x);
      const [forth, back] = stages.map((way, returns) => way.map(({ now, change }) => {
        return [pressureOf(now, x), returns ? dq - 2 * change(x) : 2 * change(x)];
      }));
      const first = [pressureOf(one, x), 0], second = [pressureOf(two, x), dq];
      [-1, 1].forEach((side, i) => {
        const [there, again] = [[first, ...forth, second], [second, ...back, first]].map((states) => {
          return states.map(([p, moved]) => p - side * moved);
        });
        const spare = Math.min(there[0], again[0]) - Math.min(least(there), least(again));
        taken[i] += zone.c * Math.PI / PLACES * Math.sin(angle) * spare;
      });
    }
    return taken;
  }

  // The smallest of evenly spaced values, on the parabola through the smallest one and its neighbours.
  function least(values) {
    const i = values.indexOf(Math.min(...values)), [before, at, after] = [i - 1, i, i + 1].map((k) => values[k]);
    const bend = before - 2 * at + after;
    return bend > 0 ? at - (after - before) ** 2 / (8 * bend) : at;
  }

  // 0, the changes of sign of a function between 0 and pi, and pi.
  function turns(of) {
    const angles = Array.from({ length: SAMPLES - 1 }, (_, i) => Math.PI * (i + 1) / SAMPLES), values = angles.map(of);
    const between = angles.slice(1).flatMap((to, i) => {
      if (values[i] > 0 === values[i + 1] > 0) return [];
      return halved(angles[i], to, HALVINGS, (angle) => of(angle) > 0 === values[i] > 0);
    });
    return [0, ...between, Math.PI];
  }

  const integral = (of, at) => at.slice(1).reduce((total, to, i) => total + (to - at[i]) / 2 * hertz.rule.reduce(
    (sum, { node, weight }) => sum + weight * of((at[i] + to) / 2 + (to - at[i]) / 2 * node), 0), 0);

  // Whether slip reverses at an end on the straight way from one load point to the other: an end of the stick zone then
  // moves outwards, or slip begins in the other direction.
  function reverses(contacts, Qf, sf, s) {
    return [contacts, [contacts[1], contacts[0]]].some(([one, two]) => {
      const [left, right] = rates([one, two], Qf, sf, 0);
      if (right.q < Math.abs(right.p) - ROUNDING || s * left.q < Math.abs(left.p) - ROUNDING) return true;
      // rates are linear in between: at the ends of the stick zone, slip must not begin the other way
      const [low, high] = ends(stickZone([one, two], Qf, sf)).map((x) => {
        const share = clamp((x - one.e + one.a) / (2 * one.a), 0, 1);
        return { q: left.q + share * (right.q - left.q), p: left.p + share * (right.p - left.p) };
      });
      if (high.q < -high.p - ROUNDING || s * low.q < -low.p - ROUNDING) return true;
      const shares = [0.25, 0.5, 0.75, 0.999, 1];
      const zones = shares.map((share) => stickZone([one, between(one, two, share)], share * Qf, share * sf));
      return zones.some((zone, i) => {
        if (!zone || zone.s !== s) return true;
        const [low, high] = ends(zone), [lowBefore, highBefore] = ends(zones[i - 1] ?? zone);
        return high > highBefore + ROUNDING || low < lowBefore - ROUNDING;
      });
    });
  }

  function between(one, two, share) {
    const square = one.a ** 2 + share * (two.a ** 2 - one.a ** 2);
    const moment = (1 - share) * one.a ** 2 * one.e + share * two.a ** 2 * two.e;
    return { a: Math.sqrt(square), e: moment / square };
  }

  // The steady state for Qf >= 0 and sf >= 0: `zone` if both ends slip, `q` (function of x, half-change) and `means`,
  // each null where it has no formula. `sticking`: of the left and the right end, if not both slip.
  function solve(contacts, Qf, sf) {
    const stuck = sticking(contacts, Qf, sf), whole = stuck.every((end) => end === "always");
    const zone = whole ? null : stickZone(contacts, Qf, sf);
    const q = zone || whole ? halfChange(contacts, zone, adhered(contacts, Qf, sf)) : null;
    const means = q && meanLoads(contacts, zone, Qf, sf, q);
    if (zone || whole) return { zone, sticking: stuck, q, means };
    // a slip zone that would end beyond the common contact is there during part of the cycle at most
    const [low, high] = common(contacts), [left, right] = ends(alike(contacts, Qf, sf));
    const beyond = [left < low, right > high];
    return { zone, sticking: stuck.map((end, i) => (end === "never" && beyond[i] ? "partly" : end)), q, means };
  }

  return {
    beginning, common, conditions, ends, grid, largest, pressure, pressureOf, reverses, solve, stickZone, union,
  };
})();
