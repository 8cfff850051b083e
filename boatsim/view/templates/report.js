"use strict";
// Shows the values under the pointer, which it reads back from the drawn lines, and plays the replay.
// It fetches nothing.
const GRID = 2000; // units of a drawing along each edge, as in svg_plots.py
const SNAP = 60; // largest distance of the pointer from a point, in these units

function quantity(title) {
  const unit = /\[([^\]]*)\]/.exec(title);
  return [title.split(/[[,;]/)[0].trim(), unit ? unit[1] : ""];
}
function formatted(value, span, unit) {
  const digits = Math.max(0, Math.min(6, 3 - Math.ceil(Math.log10(span || 1))));
  return value.toFixed(digits).replace(/^-(?=[0.]*$)/, "").replace("-", "\u2212") + (unit.startsWith("\u00b0") ? "" : "\u00a0") + unit;
}
function element(kind, look, text) {
  const created = document.createElement(kind);
  created.className = look;
  if (text) created.textContent = text;
  return created;
}

// Values under the pointer -------------------------------------------------------------------------------------------

function points(path) {
  if (!path.points) {
    const times = path.dataset.t ? path.dataset.t.split(" ").map(Number) : null;
    const d = path.getAttribute("d");
    path.points = (d ? d.slice(1).split("L") : []).map((pair, i) => {
      const [x, y] = pair.split(" ").map(Number);
      return { x, y, t: times ? times[i] : x, name: path.dataset.name || path.classList[1], look: path.classList[1] };
    });
  }
  return path.points;
}
function nearest(all, distance, within) {
  let best = null, least = within;
  for (const p of all) {
    const d = distance(p);
    if (d < least) [best, least] = [p, d];
  }
  return best;
}
function readable(plot) {
  const ends = axis => plot.dataset[axis].split(" ").map(Number);
  const [x0, x1] = ends("x"), [y0, y1] = ends("y");
  const across = quantity(plot.dataset.across), up = quantity(plot.dataset.up);
  const tip = element("div", "tip"), hair = element("div", "hair");
  tip.hidden = hair.hidden = true;
  plot.append(hair, tip);
  const value = (p, axis) => axis === "x"
    ? formatted(x0 + (x1 - x0) * p.x / GRID, x1 - x0, across[1])
    : formatted(y1 - (y1 - y0) * p.y / GRID, y1 - y0, up[1]);
  function show(event) {
    const box = plot.getBoundingClientRect();
    const px = GRID * (event.clientX - box.left) / box.width, py = GRID * (event.clientY - box.top) / box.height;
    const paths = [...plot.querySelectorAll("path.line")], timed = paths.some(p => p.dataset.t);
    const all = paths.flatMap(points);
    const from = timed
      ? p => Math.hypot(p.x - px, (p.y - py) * box.height / box.width)
      : p => Math.abs(p.x - px);
    const under = nearest(all, from, SNAP);
    tip.hidden = !under;
    hair.hidden = !under || timed;
    if (!under) return;
    const head = timed ? formatted(under.t, 100, "s") : `${up[0]}, ${across[0]} ${value(under, "x")}`;
    tip.replaceChildren(element("div", "at", head));
    for (const name of new Set(all.map(p => p.name))) {
      const p = nearest(all.filter(p => p.name === name), p => Math.abs(p.t - under.t), timed ? 2 : SNAP / 2);
      if (!p || p.y <= -GRID || p.y >= 2 * GRID) continue;
      const words = timed ? `${up[0]} ${value(p, "y")}, ${across[0]} ${value(p, "x")}` : value(p, "y");
      tip.append(element("div", p.look, `${name} ${words}`));
    }
    hair.style.left = `${100 * under.x / GRID}%`;
    tip.style.left = px < GRID / 2 ? `calc(${100 * px / GRID}% + 12px)` : "auto";
    tip.style.right = px < GRID / 2 ? "auto" : `calc(${100 - 100 * px / GRID}% + 12px)`;
    tip.style.top = `${Math.max(0, Math.min(70, 100 * py / GRID - 10))}%`;
  }
  plot.addEventListener("pointermove", show);
  plot.addEventListener("pointerdown", show);
  plot.addEventListener("pointerleave", () => { tip.hidden = hair.hidden = true; });
}

// The replay ----------------------------------------------------------------------------------------------------------

function distance(metres) {
  if (metres < 0.01) return `${(1000 * metres).toFixed(1)}\u00a0mm`;
  return metres < 1 ? `${(100 * metres).toFixed(1)}\u00a0cm` : `${metres.toFixed(2)}\u00a0m`;
}
function replayed(stage) {
  const film = JSON.parse(stage.querySelector("script").textContent);
  const plot = stage.querySelector(".plot"), svg = plot.querySelector("svg");
  const controls = stage.querySelector(".controls"), button = controls.querySelector("button");
  const slider = controls.querySelector("input"), output = controls.querySelector("output");
  const [x0, x1] = plot.dataset.x.split(" ").map(Number), [y0, y1] = plot.dataset.y.split(" ").map(Number);
  const hulls = film.boats.map(boat => {
    const hull = document.createElementNS(svg.namespaceURI, "path");
    hull.setAttribute("class", `hull ${boat.look}`);
    svg.append(hull);
    return hull;
  });
  const cursors = film.cursor ? [...document.querySelectorAll('.plot[data-across="time [s]"]')].filter(p => !stage.contains(p)).map(p => {
    const now = element("div", "now");
    p.append(now);
    return [now, ...p.dataset.x.split(" ").map(Number)];
  }) : [];
  const first = film.t[0], last = film.t[film.t.length - 1];
  let time = film.t[film.start], playing = false, before = 0;

  function at(values, k, part) {
    const a = values[k], b = values[Math.min(k + 1, values.length - 1)];
    return a === null || b === null ? a : a + part * (b - a);
  }
  function show() {
    let k = 0, high = film.t.length - 1;
    while (high - k > 1) {
      const middle = (k + high) >> 1;
      if (film.t[middle] < time) k = middle; else high = middle;
    }
    const step = film.t[k + 1] - film.t[k], part = step > 0 ? Math.min(1, (time - film.t[k]) / step) : 0;
    const box = svg.getBoundingClientRect(), down = GRID / (y1 - y0), right = down * box.height / box.width;
    const places = film.boats.map((boat, i) => {
      const [x, y, a] = [boat.x, boat.y, boat.turned].map(v => at(v, k, part));
      if (x === null || y === null || !(box.width > 0)) { hulls[i].setAttribute("d", ""); return null; }
      const c = Math.cos(a || 0), s = Math.sin(a || 0), cx = GRID * (x - x0) / (x1 - x0), cy = GRID * (y1 - y) / (y1 - y0);
      const corners = film.outline.map(([p, q]) => `${(cx + right * (p * c - q * s)).toFixed(1)} ${(cy + down * (p * s + q * c)).toFixed(1)}`);
      hulls[i].setAttribute("d", `M${corners.join("L")}Z`);
      return [x, y];
    });
    const words = film.boats.map((boat, i) => {
      if (!places[i]) return "";
      if (!film.plan) return `${boat.name} ${formatted(places[i][1], y1 - y0, film.unit)}`;
      return i && places[0] ? `${boat.name} ${distance(Math.hypot(places[i][0] - places[0][0], places[i][1] - places[0][1]))} off` : "";
    });
    const numbers = (film.readouts || []).map(r => r.values[k] === null ? ""
      : `${r.name} ${r.values[k].toFixed(r.decimals).replace("-", "\u2212")}${r.unit.startsWith("\u00b0") ? "" : "\u00a0"}${r.unit}`);
    output.textContent = [film.readouts ? formatted(time, 100, "s") : `at ${formatted(time, 100, "s")} of this run`, ...(film.readouts ? [] : words.filter(Boolean)), ...numbers.filter(Boolean)].join(" \u00b7 ");
    for (const [now, low, high] of cursors) now.style.left = `${100 * Math.max(0, Math.min(1, (time - low) / (high - low)))}%`;
    slider.value = time;
  }
  function play(on) {
    playing = on;
    button.textContent = on ? "Pause" : "Play";
    if (on) {
      if (time >= last) time = first;
      before = performance.now();
      requestAnimationFrame(step);
    }
  }
  function step(now) {
    if (!playing) return;
    time = Math.min(last, time + film.rate * (now - before) / 1000);
    before = now;
    show();
    if (time >= last) play(false); else requestAnimationFrame(step);
  }
  slider.min = first;
  slider.max = last;
  slider.step = "any";
  slider.addEventListener("input", () => { play(false); time = Number(slider.value); show(); });
  button.addEventListener("click", () => play(!playing));
  window.addEventListener("resize", show);
  controls.hidden = false;
  show();
}

document.querySelectorAll(".plot").forEach(readable);
document.querySelectorAll(".replay").forEach(replayed);
