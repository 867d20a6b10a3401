"use strict";

// The loads set by the controls, the solution for them, and the table of numbers. The page starts with the settings in
// the link, else with those of the scene.
const page = (() => {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const by = (id) => document.getElementById(id);
  const DIGITS = 5, LARGEST = 1e9;  // digits shown of a setting, and largest setting accepted

  // P and |dQ| (N/m), and |dsigma| (Pa); `turn` is the sign of dQ, `mirror` the sign of dQ dsigma.
  const start = {
    P: scene.P, f: scene.f, dQ: Math.abs(scene.dQ), dsigma: Math.abs(scene.dsigma),
    turn: scene.dQ < 0 ? -1 : 1, mirror: scene.dQ * scene.dsigma < 0 ? -1 : 1,
  };
  if (scene.dQ === 0 && scene.dsigma < 0) start.turn = -1;
  let loads = { ...start };
  const pressed = (P) => ({ a: scene.a * Math.sqrt(P / scene.P), p0: scene.p0 * Math.sqrt(P / scene.P) });

  const prefixes = [[9, "G"], [6, "M"], [3, "k"], [0, ""], [-3, "m"], [-6, "\u00b5"], [-9, "n"]];
  // Factor and label of the unit in which a number (SI) is shown: the scene's, or SI with a prefix.
  function shownIn(number, unit) {
    if (scene.units[unit]) return { label: scene.units[unit][0], factor: scene.units[unit][1] };
    number = +number.toPrecision(12);
    const [exponent, letter] = prefixes.find(([power]) => Math.abs(number) >= 10 ** power) ?? [0, ""];
    return { factor: 10 ** exponent, label: letter + unit };
  }
  function engineering(number, unit, digits) {
    if (!scene.units[unit] && (Math.abs(number) < 1e-9 || Math.abs(number) >= 1e12)) {
      return `${+number.toPrecision(4)} ${unit}`;
    }
    const { factor, label } = shownIn(number, unit);
    return `${+(number / factor).toPrecision(digits)} ${label}`;
  }
  const minus = (text) => text.replace(/-(?=[\d.])/g, "\u2212");

  // Solution for the loads, by the exact method. Lengths are scaled by a, pressures by p0. hertz.js solves for
  // dQ, dsigma >= 0; `mirror` and `turn` give the solution for other signs.
  function answer(loads) {
    const { P, dQ, dsigma, f, turn, mirror } = loads;
    const { a, p0 } = pressed(P), Qf = dQ / (2 * f * P), sf = dsigma / (f * p0);
    const found = {
      P, a, p0, Qf, sf, f, turn, mirror, zone: null, stick: null, ends: null, points: [], means: null, m: null, n: null,
      q: null, reverses: false, gradual: false,
    };
    if (!(Math.abs(scene.Q_mean) + dQ / 2 < f * P)) return { ...found, regime: "sliding" };

    const solved = steady(Qf, sf), { stick, ends, points, means = null } = solved, ascending = (one, two) => one - two;
    const placed = stick.map((x) => mirror * x).sort(ascending);
    const limits = means && means.map((limit) => turn * limit).sort(ascending), mean = scene.Q_mean / (f * P);
    const ratchets = limits && !(limits[0] <= mean && mean <= limits[1]);
    return {
      ...found,
      ...solved,
      stick: placed,
      ends: mirror > 0 ? ends : [ends[1], ends[0]],
      points: points.map(({ x, q }) => ({ x: mirror * x, q: turn * q })),
      means: limits,
      m: -placed[0],
      n: placed[1],
      regime: ratchets ? "ratchets" : solved.regime,
    };
  }

  const tensile = ({ s }) => (s > 0 ? "small tension" : "large tension");

  // The steady state for Qf, sf >= 0. `ends`: direction of slip at the left and the right end, times `turn`.
  function steady(Qf, sf) {
    const once = hertz.stickZone(Qf, sf), reverses = hertz.reverses(once, Qf, sf);
    const gradual = reverses ? hertz.gradualZone(scene.table, once, Qf, sf) : null, zone = gradual ?? once;
    const found = { zone, stick: [zone.centre - zone.c, zone.centre + zone.c], ends: [zone.s, 1], regime: tensile(zone) };
    if (gradual) {  // q and the limits of its mean depend on the way
      const same = gradual === once;
      return { ...found, gradual: true, points: same ? hertz.tractions(zone) : [], q: same ? hertz.largest(zone) : null };
    }
    const bound = hertz.meanLoadBound(zone, Qf, sf);
    found.means = [-bound, bound];
    if (Qf === 0 && sf === 0) return { ...found, points: [{ x: -1, q: 0 }, { x: 1, q: 0 }], q: 0, regime: "stuck" };
    return { ...found, points: hertz.tractions(zone), q: hertz.largest(zone), reverses };
  }

  const REGIMES = {
    stuck: "Q and \u03c3 do not change",
    "small tension": "both ends slip in the same direction",
    "large tension": "the ends slip in opposite directions",
    sliding: "the whole contact slides: there is no stick zone",
    ratchets: "every cycle adds slip: the mean of Q is beyond the limits of a steady state; m and n are not reached",
  };
  function note({ reverses, gradual, points }) {
    if (gradual) {
      return "Slip at one end turns round on the way. m and n are those of gradual loads, within 1e-4 a; " +
        (points.length ? "" : "q is not drawn, ") + "the limits of the mean of Q are not given: run the exact method.";
    }
    return reverses ? "Under a gradual load path between these load points, slip at one end reverses. q then differs " +
      "from the closed form; march with load.steps gives the difference." : "";
  }

  // [scaled, dimensional] values of the table.
  function numbers(found) {
    const { P, a, p0, f, zone, m, n, q, means } = found, none = ["none", ""];
    const length = (at) => engineering(at * a, "m", 6);
    const table = {
      m: none, n: none, width: none, q: none, most: none, a: ["", length(1)], p0: ["", engineering(p0, "Pa", 6)],
      ...limits(found),
    };
    if (means) table.most = [`${means[1].toFixed(5)} f P`, engineering(means[1] * f * P, "N/m", 6)];
    if (q !== null) table.q = [`${q.toFixed(7)} f p0`, engineering(q * f * p0, "Pa", 6)];
    if (!zone) return table;
    const width = 2 * zone.c;
    return {
      ...table,
      m: [`${m.toFixed(7)} a`, length(m)],
      n: [`${n.toFixed(7)} a`, length(n)],
      width: [`${width < 1e-4 ? width.toExponential(4) : width.toFixed(7)} a`, length(width)],
    };
  }

  // dsigma at which large tension begins, and dQ at which the contact slides.
  function limits({ P, p0, f, Qf }) {
    const slides = Math.max(2 * (f * P - Math.abs(scene.Q_mean)), 0), share = +(slides / (2 * f * P)).toFixed(5);
    const turns = Qf < 1 ? hertz.transition(Qf) : null;
    return {
      slides: [share === 1 ? "2 f P" : `${share} \u00b7 2 f P`, engineering(slides, "N/m", 6)],
      turns: turns === null ? ["none", ""] : [`${turns.toFixed(5)} f p0`, engineering(turns * f * p0, "Pa", 6)],
    };
  }

  // Controls of loads and friction: how to read and set each value, and the values allowed.
  const shear = () => loads.turn * loads.dQ, tension = () => loads.turn * loads.mirror * loads.dsigma;
  function sized(dQ, dsigma) {
    const turn = Math.sign(dQ) || Math.sign(dsigma) * loads.mirror || loads.turn;
    const mirror = Math.sign(dsigma) ? turn * Math.sign(dsigma) : loads.mirror;
    return { dQ: Math.abs(dQ), dsigma: Math.abs(dsigma), turn, mirror };
  }
  const normal = shownIn(scene.P, "N/m"), force = shownIn(2 * scene.f * scene.P, "N/m");
  const stress = shownIn(scene.f * scene.p0, "Pa");
  const nice = (value) => 10 ** Math.floor(Math.log10(value / 50));  // step of a slider that goes to 4 times the value
  const step = nice(scene.P / normal.factor);
  const controls = {
    P: {
      get: ({ P }) => P / normal.factor, set: (value) => ({ P: value * normal.factor }), least: step / 1e6,
    },
    Qf: { get: ({ Qf }) => Qf, set: (value) => ({ dQ: value * 2 * loads.f * loads.P }) },
    sf: { get: ({ sf }) => sf, set: (value) => ({ dsigma: value * loads.f * pressed(loads.P).p0 }) },
    f: { get: ({ f }) => f, set: (value) => ({ f: value }), least: 1e-6 },
    dQ: { get: () => shear() / force.factor, set: (value) => sized(value * force.factor, tension()), least: -LARGEST },
    dsigma: {
      get: () => tension() / stress.factor, set: (value) => sized(shear(), value * stress.factor), least: -LARGEST,
    },
  };
  const allowed = (name, value) => value >= (controls[name].least ?? 0) && value <= (controls[name].most ?? LARGEST);

  // The link: P, f, dQ and dsigma, in SI units. A zero keeps its sign, which tells how the loads turn and are mirrored.
  const SHOWN = { P: normal, f: { factor: 1 }, dQ: force, dsigma: stress };
  const NUMBER = /^-?\d{1,20}(\.\d{1,20})?(e-?\d{1,3})?$/i;
  const sign = (value) => (value < 0 || Object.is(value, -0) ? -1 : 1);
  function link() {
    const known = { P: loads.P, f: loads.f, dQ: shear(), dsigma: tension() };
    const text = (value) => (Object.is(value, -0) ? "-0" : String(+value.toPrecision(12)));
    return `#${Object.entries(known).map(([key, value]) => `${key}=${text(value)}`).join("&")}`;
  }
  function linked() {
    const found = new URLSearchParams(location.hash.slice(1)), given = {};
    for (const [key, { factor }] of Object.entries(SHOWN)) {
      const text = found.get(key) ?? "", value = Number(text);
      if (NUMBER.test(text) && allowed(key, value / factor)) given[key] = value;
    }
    const { dQ, dsigma, ...others } = given;
    const signed = { dQ: dQ ?? start.turn * start.dQ, dsigma: dsigma ?? start.turn * start.mirror * start.dsigma };
    const turn = sign(signed.dQ), mirror = turn * sign(signed.dsigma);
    return { ...start, ...others, dQ: Math.abs(signed.dQ), dsigma: Math.abs(signed.dsigma), turn, mirror };
  }
  const REST = 400;  // ms: browsers refuse many changes of the address in a short time
  let resting = 0;
  function address() {
    by("link").href = link();
    clearTimeout(resting);
    resting = setTimeout(() => {
      const changed = Object.keys(start).some((key) => loads[key] !== start[key]);
      try {
        history.replaceState(null, "", changed ? link() : location.href.split("#")[0]);
      } catch (error) {
        if (error.name !== "SecurityError") throw error;  // in a notebook's frame the address is not the page's own
      }
    }, REST);
  }

  let draw = [];
  function show() {
    const found = answer(loads);
    for (const figure of draw) figure(found);
    for (const [name, control] of Object.entries(controls)) {
      const value = control.get(found);
      for (const input of document.querySelectorAll(`[data-sets="${name}"]`)) {
        if (input.type === "range") {
          input.value = value;
          input.setAttribute("aria-valuetext", String(+value.toPrecision(DIGITS)));
        } else if (input !== document.activeElement) {
          input.value = +value.toPrecision(DIGITS);
          input.removeAttribute("aria-invalid");
        }
      }
    }
    by("opposite").checked = loads.mirror < 0;
    by("regime").textContent = `${found.regime}:`;
    by("meaning").textContent = REGIMES[found.regime];
    for (const [key, cells] of Object.entries(numbers(found))) {
      cells.forEach((text, column) => { by(`${key}-${column}`).textContent = minus(text); });
    }
    by("note").textContent = note(found);
    const ends = found.zone ? `m = ${found.m.toFixed(3)} a, n = ${found.n.toFixed(3)} a` : "no stick zone";
    by("tractions").setAttribute("aria-label", `Tractions over the contact: ${found.regime}, ${ends}`);
  }

  function change(settings) {
    loads = { ...loads, ...settings };
    show();
    address();
  }

  function listen() {
    for (const input of document.querySelectorAll("[data-sets]")) {
      const { set } = controls[input.dataset.sets];
      input.addEventListener("input", () => {
        const value = input.valueAsNumber, fine = allowed(input.dataset.sets, value);
        input.setAttribute("aria-invalid", String(!fine));
        if (fine) change(set(value));
      });
      input.addEventListener("blur", show);
    }
    by("opposite").addEventListener("change", (event) => change({ mirror: event.target.checked ? -1 : 1 }));
    by("reset").addEventListener("click", () => change(start));
    addEventListener("hashchange", () => change(linked()));
  }

  function layOut() {
    const move = (Qf, sf) => change({ ...controls.Qf.set(Qf), ...controls.sf.set(sf) });
    draw = [
      figures.tractions(by("tractions"), ({ a }) => `x/a    (a = ${engineering(a, "m", 5)})`),
      figures.map(by("map"), scene.map, move),
    ];
    show();
  }

  const most = Math.ceil(4 * scene.P / normal.factor / step) * step;
  Object.entries({ min: step, max: most, step }).forEach(([name, value]) => by("P").setAttribute(name, +value.toPrecision(12)));
  for (const [key, { label }] of Object.entries(SHOWN)) if (label) by(`${key}-unit`).textContent = label;
  loads = linked();
  by("link").href = link();
  listen();
  layOut();
  const frames = ["tractions", "map"].map((id) => by(id).parentNode);
  const sizes = () => frames.map((frame) => frame.clientWidth).join();
  let shown = sizes();
  const observer = new ResizeObserver(() => {
    if (sizes() === shown) return;
    shown = sizes();
    layOut();
  });
  for (const frame of frames) observer.observe(frame);

  return { answer: () => answer(loads), loads: () => loads };
})();
