"use strict";

// The two figures, drawn in their size on the page: tractions over the contact, and the stick-zone map with the loads
// as a point to drag.
const figures = (() => {
  const NAMESPACE = "http://www.w3.org/2000/svg";
  const STRIP = 0.04;  // width of the strip of sliding, beyond dQ = 2 f P
  const ROOM = 44;  // width of a word in a zone, pixels

  function element(parent, tag, attributes = {}, text = "") {
    const made = document.createElementNS(NAMESPACE, tag);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    parent.append(made);
    return made;
  }

  const path = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(2)} ${y.toFixed(2)}`).join("");
  const tick = (value) => String(+value.toFixed(2)).replace("-", "\u2212");

  // Clears the SVG and draws axes over the ranges. Returns the scales and a layer clipped to the axes.
  function axes(svg, { x, y, xTicks, yTicks, xLabel, yLabel }) {
    const width = Math.max(Math.round(svg.parentNode.clientWidth), 240);
    const height = Math.round(Math.max(0.62 * width, Math.min(0.8 * width, 300)));
    const box = { left: 56, right: width - 10, top: 10, bottom: height - 44 };
    const toX = (value) => box.left + (value - x[0]) / (x[1] - x[0]) * (box.right - box.left);
    const toY = (value) => box.bottom - (value - y[0]) / (y[1] - y[0]) * (box.bottom - box.top);
    const fromX = (at) => x[0] + (at - box.left) / (box.right - box.left) * (x[1] - x[0]);
    const fromY = (at) => y[0] + (box.bottom - at) / (box.bottom - box.top) * (y[1] - y[0]);
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const clip = element(element(svg, "clipPath", { id: `${svg.id}-box` }), "rect");
    const size = { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top };
    for (const [key, value] of Object.entries(size)) clip.setAttribute(key, value);
    const back = element(svg, "g", { "clip-path": `url(#${svg.id}-box)` });
    const corners = [[box.left, box.top], [box.left, box.bottom], [box.right, box.bottom]];
    element(svg, "path", { class: "axis", d: path(corners) });
    for (const at of xTicks) {
      element(svg, "path", { class: "axis", d: path([[toX(at), box.bottom], [toX(at), box.bottom + 5]]) });
      element(svg, "text", { class: "tick", x: toX(at), y: box.bottom + 18, "text-anchor": "middle" }, tick(at));
    }
    for (const at of yTicks) {
      element(svg, "path", { class: "axis", d: path([[box.left - 5, toY(at)], [box.left, toY(at)]]) });
      element(svg, "text", { class: "tick", x: box.left - 8, y: toY(at) + 4, "text-anchor": "end" }, tick(at));
    }
    const below = { x: (box.left + box.right) / 2, y: height - 6, "text-anchor": "middle" };
    const across = element(svg, "text", below, xLabel);
    const middle = (box.top + box.bottom) / 2;
    element(svg, "text", { transform: `translate(12 ${middle}) rotate(-90)`, "text-anchor": "middle" }, yLabel);
    return { toX, toY, fromX, fromY, box, back, across, front: element(svg, "g") };
  }

  // Returns draw(answer): tractions and stick zone of the loads. `xLabel` gives the label of the axis for an answer.
  function tractions(svg, xLabel) {
    const plot = axes(svg, {
      x: [-1.04, 1.04], y: [-1.1, 1.3], xTicks: [-1, -0.5, 0, 0.5, 1], yTicks: [-1, -0.5, 0, 0.5, 1], xLabel: "",
      yLabel: "p/p0 and q/(f p0)",
    });
    const { toX, toY, box } = plot, grid = Array.from({ length: 61 }, (_, i) => -Math.cos(Math.PI * i / 60));
    return (answer) => {
      const { stick, points, ends, turn, regime } = answer;
      plot.across.textContent = xLabel(answer);
      plot.back.replaceChildren();
      plot.front.replaceChildren();
      const word = (low, high, text) => {
        if (toX(high) - toX(low) < ROOM || !text) return;
        element(plot.front, "text", { x: (toX(low) + toX(high)) / 2, y: box.top + 15, "text-anchor": "middle" }, text);
      };

      if (stick) {
        const width = Math.max(toX(stick[1]) - toX(stick[0]), 1);  // show the narrowest zone
        const size = { y: box.top, width, height: box.bottom - box.top };
        element(plot.back, "rect", { class: "stick", x: toX(stick[0]), ...size });
        const sides = stick.map((x) => path([[toX(x), box.top], [toX(x), box.bottom]]));
        element(plot.back, "path", { class: "ends", d: sides.join("") });
      }
      element(plot.back, "path", { class: "zero", d: path([[box.left, toY(0)], [box.right, toY(0)]]) });
      for (const way of [1, -1]) {
        const bound = grid.map((x) => [toX(x), toY(way * hertz.pressure(x))]);
        element(plot.back, "path", { class: "pressure", d: path(bound) });
      }
      element(plot.back, "path", { class: "shear", d: path(points.map(({ x, q }) => [toX(x), toY(q)])) });

      const slip = (sign) => (sign > 0 ? "slip \u2192" : sign < 0 ? "\u2190 slip" : "");
      if (regime === "sliding") word(-1, 1, "slides");
      if (!stick) return;
      word(-1, stick[0], slip(turn * ends[0]));
      word(stick[0], stick[1], "stick");
      word(stick[1], 1, slip(turn * ends[1]));
    };
  }

  // Returns draw(answer). Calls `move` with the loads (Qf, sf) to which the point is dragged or stepped.
  function map(svg, { m, n, border, top }, move) {
    const step = top > 20 ? 10 : top > 10 ? 4 : 2;
    const plot = axes(svg, {
      x: [0, 1 + STRIP], y: [0, top], xTicks: [0, 0.2, 0.4, 0.6, 0.8, 1],
      yTicks: Array.from({ length: Math.floor(top / step) + 1 }, (_, i) => step * i),
      xLabel: "\u0394Q/(2 f P)", yLabel: "\u0394\u03c3/(f p0)",
    });
    const { toX, toY, box } = plot;
    const at = ([Qf, sf]) => [toX(Qf), toY(sf)];
    const slides = { x: toX(1), y: box.top, width: box.right - toX(1), height: box.bottom - box.top };
    element(plot.back, "rect", { class: "slides", ...slides });
    const labels = [];
    for (const [kind, lines] of [["m", m], ["n", n]]) {
      for (const { value, points, label } of lines) {
        element(plot.back, "path", { class: `line-${kind}`, d: path(points.map(at)) });
        if (!label) continue;
        const [x, y] = at(label);
        if (labels.some((other) => Math.abs(other.x - x) < 46 && Math.abs(other.y - y) < 16)) continue;
        const text = element(plot.front, "text", { class: "label", x, y: y + 4, "text-anchor": "middle" });
        labels.push({ kind, value, x, y, text });
      }
    }
    element(plot.back, "path", { class: "border", d: path(border.map(at)) });
    const ray = element(plot.back, "path", { class: "ray" });
    const named = (text, x, y, anchor, turned = 0) => element(plot.front, "text", {
      class: "label region", transform: `translate(${x} ${y}) rotate(${turned})`, "text-anchor": anchor,
    }, text);
    named("small tension", toX(0.985), toY(0.03 * top), "end");
    named("large tension", toX(0.02), toY(0.94 * top), "start");
    named("sliding", toX(1 + STRIP / 2) + 4, toY(0.5 * top), "middle", -90);
    const handle = element(plot.front, "g", { class: "handle", tabindex: 0, role: "slider" });
    handle.setAttribute("aria-valuemin", 0);
    handle.setAttribute("aria-valuemax", 1);
    handle.setAttribute("aria-label", "Loads on the map; arrow keys move them");
    element(handle, "circle", { class: "target", r: 22 });
    element(handle, "circle", { class: "halo", r: 12 });
    element(handle, "circle", { class: "dot", r: 7 });
    let now = { Qf: 0, sf: 0 };

    const within = (Qf, sf) => move(Math.min(Math.max(Qf, 0), 1), Math.min(Math.max(sf, 0), top));
    const drag = (event) => {
      const { left, top: above } = svg.getBoundingClientRect();
      within(plot.fromX(event.clientX - left), plot.fromY(event.clientY - above));
    };
    svg.onpointerdown = (event) => {
      const { left, top: above } = svg.getBoundingClientRect(), x = event.clientX - left, y = event.clientY - above;
      // a touch beside the point scrolls the page
      if (event.pointerType !== "mouse" && !handle.contains(event.target)) return;
      if (x < box.left || x > box.right || y < box.top || y > box.bottom) return;
      svg.setPointerCapture(event.pointerId);
      handle.focus({ preventScroll: true });
      event.preventDefault();
      drag(event);
    };
    handle.addEventListener("touchstart", (event) => event.preventDefault(), { passive: false });  // do not scroll
    svg.onpointermove = (event) => { if (svg.hasPointerCapture(event.pointerId)) drag(event); };
    handle.onkeydown = (event) => {
      const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (!way) return;
      event.preventDefault();
      const pace = event.shiftKey ? 0.1 : 0.01;
      within(now.Qf + pace * way[0], now.sf + pace * top * way[1]);
    };

    return (answer) => {
      now = answer;
      // a change of f moves the loads along a ray; beyond the map the point stays at the border
      const far = Math.min((1 + STRIP) / Math.max(answer.Qf, 1e-9), top / Math.max(answer.sf, 1e-9));
      const on = (share) => at([answer.Qf * share, answer.sf * share]);
      ray.setAttribute("d", path([at([0, 0]), on(far)]));
      handle.setAttribute("transform", `translate(${on(Math.min(far, 1)).join(" ")})`);
      handle.setAttribute("aria-valuenow", Math.min(answer.Qf, 1));
      const [Qf, sf] = [answer.Qf, answer.sf].map((value) => +value.toFixed(4));
      handle.setAttribute("aria-valuetext", `\u0394Q/(2 f P) = ${Qf}, \u0394\u03c3/(f p0) = ${sf}`);
      handle.classList.toggle("beyond", far < 1);
      const name = (end) => (answer.mirror > 0 ? end : { m: "n", n: "m" }[end]);  // swapped if mirrored
      for (const { kind, value, text } of labels) {
        text.textContent = `${name(kind)} ${value.toFixed(1)}`.replace("-", "\u2212");
      }
      for (const key of document.querySelectorAll("[data-end]")) key.textContent = name(key.dataset.end);
    };
  }

  return { map, tractions };
})();
