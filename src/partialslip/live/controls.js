"use strict";

// The loads set by the controls, the solution for them, and the table of numbers. The page starts with the settings in
// the link, else with those of the scene.
const page = (() => {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const by = (id) => document.getElementById(id);
  const DIGITS = 5, LARGEST = 1e9;  // digits shown of a setting, and largest setting accepted

  // P and |dQ| (N/m), |dsigma| (Pa); `turn` is the sign of dQ, `mirror` the sign of dQ dsigma.
  const start = {
    P: scene.P, dQ: Math.abs(scene.dQ), dsigma: Math.abs(scene.dsigma), f: scene.f,
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
  const minus = (text) => text.replace(/-(?=[\d.])/, "\u2212");

  // Solution for the loads, by the exact method.
  function answer({ P, dQ, dsigma, f, turn, mirror }) {
    const { a, p0 } = pressed(P);
    const Qf = dQ / (2 * f * P), sf = dsigma / (f * p0), mean = Math.abs(scene.Q_mean) / (f * P);
    const found = { P, a, p0, Qf, sf, turn, mirror, f, zone: null, m: null, n: null, q: null, bound: null };
    if (f === 0 && dQ === 0 && !scene.Q_mean) return { ...found, Qf: 0, sf: 0, regime: "frictionless" };
    if (!(Qf < 1) || Qf + mean >= 1) return { ...found, regime: "sliding" };
    const zone = hertz.stickZone(Qf, sf), bound = hertz.meanLoadBound(zone, Qf);
    const stuck = Qf === 0 && sf === 0;
    let regime = zone.s > 0 ? "small tension" : "large tension";
    if (stuck) regime = "stuck";
    else if (mean > bound) regime = "ratchets";
    const centre = mirror * zone.centre, q = stuck ? 0 : hertz.largest(zone);
    return { ...found, zone, regime, bound, m: zone.c - centre, n: zone.c + centre, q };
  }

  const REGIMES = {
    stuck: "the loads do not change",
    "small tension": "both ends slip in the same direction",
    "large tension": "the ends slip in opposite directions",
    frictionless: "neither friction nor shear force: no stick zone, no sliding",
    sliding: "the whole contact slides: there is no stick zone",
    ratchets: "every cycle adds slip: the mean of Q exceeds the limit of a steady state; m and n are not reached",
  };

  function note({ zone, Qf, sf }) {
    if (!zone || sf === 0) return "";
    const turns = zone.s > 0 ? sf > 4 * Qf : zone.c * sf < 4 * Qf;
    return turns ? "Under a gradual load path between these load points, slip at one end reverses. q then differs " +
      "from the closed form; march with load.steps gives the difference." : "";
  }

  // [scaled, dimensional] values of the table.
  function numbers({ P, a, p0, zone, f, m, n, q, Qf, bound }) {
    const none = ["none", ""], length = (at) => engineering(at * a, "m", 6), turns = hertz.transition(Qf);
    const table = { m: none, n: none, width: none, q: none, turns: none, mean: none };
    table.a = ["", length(1)];
    table.p0 = ["", engineering(p0, "Pa", 6)];
    const mean = Math.min(Math.abs(scene.Q_mean) / (f * P) || 0, 1);  // 0/0 without friction
    table.slides = [mean ? `${+(1 - mean).toFixed(5)} \u00b7 2 f P` : "2 f P", engineering((1 - mean) * 2 * f * P, "N/m", 6)];
    if (Qf < 1) table.turns = [`${turns.toFixed(5)} f p0`, engineering(turns * f * p0, "Pa", 6)];
    if (!zone) return table;
    const width = 2 * zone.c;
    return {
      ...table,
      m: [`${m.toFixed(7)} a`, length(m)],
      n: [`${n.toFixed(7)} a`, length(n)],
      width: [`${width < 1e-4 ? width.toExponential(4) : width.toFixed(7)} a`, length(width)],
      q: [`${q.toFixed(7)} f p0`, engineering(q * f * p0, "Pa", 6)],
      mean: [`${bound.toFixed(5)} f P`, engineering(bound * f * P, "N/m", 6)],
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
  const step = 10 ** Math.floor(Math.log10(scene.P / normal.factor / 50));  // of the slider of P
  const controls = {
    P: { get: ({ P }) => P / normal.factor, set: (value) => ({ P: value * normal.factor }), least: step / 1e6 },
    Qf: { get: ({ Qf }) => Qf, set: (value) => ({ dQ: value * 2 * loads.f * loads.P }) },
    sf: { get: ({ sf }) => sf, set: (value) => ({ dsigma: value * loads.f * pressed(loads.P).p0 }) },
    f: { get: ({ f }) => f, set: (value) => ({ f: value }), least: 1e-6 },
    dQ: { get: () => shear() / force.factor, set: (value) => sized(value * force.factor, tension()), least: -LARGEST },
    dsigma: {
      get: () => tension() / stress.factor, set: (value) => sized(shear(), value * stress.factor), least: -LARGEST,
    },
  };
  const allowed = (name, value) => value >= (controls[name].least ?? 0) && value <= LARGEST;

  // The link: P, f, dQ and dsigma in SI units. A zero keeps its sign, which tells how the loads turn and are mirrored.
  const UNITS = { P: normal.factor, f: 1, dQ: force.factor, dsigma: stress.factor };
  const NUMBER = /^-?\d{1,20}(\.\d{1,20})?(e-?\d{1,3})?$/i;
  const sign = (value) => (value < 0 || Object.is(value, -0) ? -1 : 1);
  function link() {
    const known = { P: loads.P, f: loads.f, dQ: shear(), dsigma: tension() };
    const text = (value) => (Object.is(value, -0) ? "-0" : String(+value.toPrecision(12)));
    return `#${Object.entries(known).map(([key, value]) => `${key}=${text(value)}`).join("&")}`;
  }
  function linked() {
    const found = new URLSearchParams(location.hash.slice(1)), settings = { ...start };
    const signed = { dQ: start.turn * start.dQ, dsigma: start.turn * start.mirror * start.dsigma };
    for (const [key, unit] of Object.entries(UNITS)) {
      const text = found.get(key) ?? "", value = Number(text);
      if (NUMBER.test(text) && allowed(key, value / unit)) (key in signed ? signed : settings)[key] = value;
    }
    const turn = sign(signed.dQ), mirror = turn * sign(signed.dsigma);
    return { ...settings, dQ: Math.abs(signed.dQ), dsigma: Math.abs(signed.dsigma), turn, mirror };
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

  by("P-unit").textContent = normal.label;
  const most = Math.ceil(4 * scene.P / normal.factor / step) * step;
  for (const [key, value] of Object.entries({ min: step, max: most, step })) {
    by("P").setAttribute(key, +value.toPrecision(12));
  }
  by("dQ-unit").textContent = force.label;
  by("dsigma-unit").textContent = stress.label;
  loads = linked();
  by("link").href = link();
  listen();
  layOut();
  let width = by("map").parentNode.clientWidth;
  new ResizeObserver(() => {
    if (by("map").parentNode.clientWidth === width) return;
    width = by("map").parentNode.clientWidth;
    layOut();
  }).observe(by("map").parentNode);

  return { answer: () => answer(loads), loads: () => loads };
})();
