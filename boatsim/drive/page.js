"use strict";
// The driver's page: sticks, figures and the picture from above. A second script, `socket.js` (the boat is simulated by
// boatsim) or `offline.js` (it is simulated in the page), receives the sticks and calls `begin` and `take` with the boat.
// It defines handOver(changed, now), trouble() and showTiming().
const $ = id => document.getElementById(id), AXES = ["surge", "sway", "yaw"], DEG = 180 / Math.PI;
const SPAN = 20;  // [s] of the past that is drawn
let hello = null, frame = null, track = [], past = [], scale = 0, dirty = true, over = "", notice = "", opened = 0;

// Sticks: a gamepad, keys and what is dragged, added up ---------------------------------------------------------------
const KEYS = { KeyW: [0, 1], ArrowUp: [0, 1], KeyS: [0, -1], ArrowDown: [0, -1], KeyD: [1, 1], KeyA: [1, -1],
  KeyE: [2, 1], ArrowRight: [2, 1], KeyQ: [2, -1], ArrowLeft: [2, -1] };
const RAMP = 4;  // of a stick's way in a second, under a key
const down = new Set(), keyed = [0, 0, 0], dragged = [0, 0, 0];
let half = false, sticks = [0, 0, 0], moved = Date.now() / 1000, ticked = performance.now();

addEventListener("keydown", e => {
  half = e.shiftKey;
  if (!(e.code in KEYS) || e.ctrlKey || e.altKey || e.metaKey) return;
  down.add(e.code);
  e.preventDefault();
});
addEventListener("keyup", e => { half = e.shiftKey; down.delete(e.code); });
addEventListener("blur", () => down.clear());

function gamepad() {
  const pad = [...navigator.getGamepads ? navigator.getGamepads() : []].find(p => p && p.connected !== false && p.axes.length > 1);
  $("source").textContent = pad ? "Sticks: gamepad" : "Sticks: keys and mouse (press a button of a gamepad to use it)";
  return pad ? [-pad.axes[1], pad.axes[0], pad.axes[2] || 0] : [0, 0, 0];
}

function poll() {
  const now = performance.now(), step = RAMP * Math.min((now - ticked) / 1000, 0.1), pad = gamepad();
  ticked = now;
  const before = sticks.join();
  sticks = AXES.map((_, i) => {
    let want = 0;
    for (const code of down) if (KEYS[code][0] === i) want += KEYS[code][1];
    want = Math.max(-1, Math.min(1, want)) * (half ? 0.5 : 1);
    keyed[i] += Math.max(-step, Math.min(step, want - keyed[i]));
    const way = pad[i] + keyed[i] + dragged[i];
    return Math.round(1000 * Math.max(-1, Math.min(1, Number.isFinite(way) ? way : 0))) / 1000;
  });
  const changed = sticks.join() !== before;
  if (changed) moved = (performance.timeOrigin + now) / 1000;
  if (!document.hidden && hello && hello.ready && handOver(changed, now)) dirty = true;
}

function draggable(pad, axes) {
  const knob = e => {
    const box = pad.getBoundingClientRect(), reach = box.width / 2 - 14;
    const x = (e.clientX - box.x - box.width / 2) / reach, y = (e.clientY - box.y - box.height / 2) / reach;
    axes(x, y).forEach(([i, way]) => { dragged[i] = Math.max(-1, Math.min(1, way)); });
  };
  pad.addEventListener("pointerdown", e => { pad.setPointerCapture(e.pointerId); knob(e); });
  pad.addEventListener("pointermove", e => { if (pad.hasPointerCapture(e.pointerId)) knob(e); });
  pad.addEventListener("lostpointercapture", () => axes(0, 0).forEach(([i]) => { dragged[i] = 0; }));
}
draggable($("left"), (x, y) => [[0, -y], [1, x]]);
draggable($("right"), x => [[2, x]]);

// Messages -----------------------------------------------------------------------------------------------------------
function word() {
  const why = frame ? frame.away : "";
  $("word").textContent = notice || over || trouble() || (hello.ready && why ? `${why[0].toUpperCase()}${why.slice(1)}: commands are neutral. Sticks to the middle to take over.` : "");
  $("ready").hidden = Boolean(over || trouble() || hello.ready);
  document.body.classList.toggle("away", Boolean(over || trouble() || why || !frame));
}

// While the equations of the boat are compiled the server reports no progress: the bar follows the usual time ---------
function preparing() {
  const seconds = (performance.now() - opened) / 1000, usual = hello.usual_s;
  $("ready").firstElementChild.textContent = `The equations of ${hello.vessel} are being compiled (about ${usual} s the first time, `
    + `a moment later on): ${seconds.toFixed(0)} s so far.`;
  $("ready").lastElementChild.value = 1 - Math.exp(-1.5 * seconds / usual);
}

// Figures ------------------------------------------------------------------------------------------------------------
const angle = d => d.unit === "rad" || d.unit === "rad/s" && !d.channel;  // a shaft's speed stays in rad/s
function number(x, d, full) {
  if (x === null) return "–";
  const by = angle(d) ? DEG : 1, most = Math.abs(full * by);
  return (x * by).toFixed(most < 2 ? 3 : most < 20 ? 2 : most < 200 ? 1 : 0).replace(/^-(0\.?0*)$/, "$1");
}

function begin(what) {
  hello = what;
  $("vessel").textContent = what.vessel;
  $("controller").textContent = what.controller;
  document.title = `${what.vessel}: boatsim drive`;
  $("end").disabled = !what.ready;
  scale = 0;
  dirty = true;
  $("dials").replaceChildren(...what.dials.map(d => {
    const row = document.createElement("div");
    row.className = "dial";
    row.innerHTML = '<div><span class="name"></span><span><span class="asked"></span> <span class="reached"></span> <span class="unit"></span></span></div>'
      + '<div class="bar"><div class="fill"></div><div class="zero"></div><div class="mark"></div></div><canvas></canvas>';
    row.querySelector(".name").textContent = (d.unit ? d.key.replace(/_[^_]*$/, "") : d.key).replaceAll("_", " ");
    row.querySelector(".unit").textContent = angle(d) ? d.unit.replace("rad", "°") : d.unit;
    row.querySelector(".mark").hidden = true;
    return row;
  }));
  const does = stick => what.dials.filter(d => d.sticks.includes(stick)).map(d => d.key);
  const name = { surge: "ahead", sway: "sideways", yaw: "turn" };
  $("leftword").textContent = ["surge", "sway"].filter(s => does(s).length).map(s => name[s]).join(", ") || "does nothing here";
  $("rightword").textContent = does("yaw").length ? name.yaw : "does nothing here";
  if (!what.ready) preparing();
  word();
}

function take(now) {
  if (frame && now.t < frame.t) track = past = [];
  frame = now;
  past.push([now.t, now.goals]);
  while (past[0][0] < now.t - SPAN) past.shift();
  const last = track[track.length - 1];
  if (!last || Math.hypot(now.x - last[0], now.y - last[1]) > 0.02 * hello.length) track.push([now.x, now.y]);
  if (track.length > 8000) track.splice(0, 1000);
  dirty = true;
  word();
}

function figures() {
  $("time").textContent = `${frame.t.toFixed(1)} s`;
  showTiming();
  hello.dials.forEach((d, i) => {
    const [asked, reached] = frame.goals[i], row = $("dials").children[i], span = d.turning ? 2 * Math.PI : d.high - d.low;
    const at = x => 100 * Math.max(0, Math.min(1, ((d.turning ? x + Math.PI : x - d.low)) / span));
    const full = d.turning ? Math.PI : Math.max(Math.abs(d.low), Math.abs(d.high)), zero = at(0);
    row.querySelector(".asked").textContent = number(asked, d, full);
    row.querySelector(".reached").textContent = number(reached, d, full);
    row.querySelector(".zero").style.left = `${zero}%`;
    row.querySelector(".mark").style.left = `${at(asked ?? 0)}%`;
    row.querySelector(".mark").hidden = asked === null;
    const to = at(reached ?? 0), fill = row.querySelector(".fill").style;
    fill.left = `${Math.min(zero, to)}%`;
    fill.width = `${Math.abs(to - zero)}%`;
    trace(row.querySelector("canvas"), i, x => at(x) / 100, d.turning);
  });
  const rows = {};
  for (const [name, value] of Object.entries(frame.norms)) {
    const [, goal, kind] = name.match(/^(.*)_error_(\w+)$/);
    (rows[goal] = rows[goal] || {})[kind] = [value.toPrecision(3), hello.units[name].replace("deg", "°")];
  }
  const body = Object.entries(rows).map(([goal, of]) => line("td", [[goal], of.rms, of.largest, of.integral]));
  $("norms").replaceChildren(...body.length ? [line("th", [[""], ["rms"], ["largest"], ["integral"]]), ...body]
    : [line("td", [["of no goal: hands are on the channels"]])]);
}

function trace(canvas, i, at, turning) {  // the last seconds: asked for and reached, the latest at the right
  const c = sized(canvas), wide = canvas.clientWidth, high = canvas.clientHeight;
  const X = t => wide - 1 - (frame.t - t) / SPAN * wide, Y = x => high - 2 - at(x) * (high - 4);
  c.strokeStyle = colours.rule; c.lineWidth = 1; c.beginPath(); c.moveTo(0, Y(0)); c.lineTo(wide, Y(0)); c.stroke();
  ["reached", "asked"].forEach((name, back) => {
    c.strokeStyle = colours[name]; c.lineWidth = 1.5; c.beginPath();
    let last = null;
    for (const [t, goals] of past) {
      const x = goals[i][1 - back];
      if (x === null) { last = null; continue; }
      const jump = last === null || turning && Math.abs(x - last) > Math.PI;
      jump ? c.moveTo(X(t), Y(x)) : c.lineTo(X(t), Y(x));
      last = x;
    }
    c.stroke();
  });
}

function line(kind, cells) {
  const row = document.createElement("tr");
  for (const [text, unit] of cells) {
    const cell = row.appendChild(document.createElement(kind));
    cell.textContent = unit ? `${text} ` : text;
    if (unit) cell.appendChild(document.createElement("small")).textContent = unit;
  }
  return row;
}

function pads() {
  const put = (pad, x, y) => { const r = $(pad).clientWidth / 2 - 14, k = $(pad).firstElementChild.style;
    k.transform = `translate(${r * x}px, ${r * y}px)`; };
  put("left", sticks[1], -sticks[0]);
  put("right", sticks[2], 0);
}

// The sea from above: x, ahead at the start, points up; y, to starboard, right ----------------------------------------
let colours = {};
function paint() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["ink", "soft", "water", "grid", "beyond", "hull", "edge", "track", "thrust", "wind", "rule", "asked", "reached"]) colours[name] = style.getPropertyValue(`--${name}`);
  dirty = true;
}
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", paint);

function sized(canvas) {  // its context, empty, in pixels of the page
  const ratio = devicePixelRatio || 1, size = [canvas.clientWidth, canvas.clientHeight].map(x => Math.round(x * ratio));
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const c = canvas.getContext("2d");
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
  return c;
}

function atStart() {  // the state before the first frame
  const [x, y, psi] = hello.start;
  return { x, y, psi, thrusts: hello.thrusters.map(() => [0, 0]), wind: null, contacts: 0 };
}

function draw(frame) {
  const canvas = $("sea"), wide = canvas.clientWidth, high = canvas.clientHeight;
  const c = sized(canvas), tank = hello.tank, [x0, y0, course] = hello.start;
  if (!scale) scale = tank ? 0.88 * Math.min(wide / tank[1], high / tank[0]) : Math.min(wide, high) / (6 * hello.length);
  const middle = tank ? turned(tank[2], tank[3], course, x0, y0) : [frame.x, frame.y];
  const X = (x, y) => wide / 2 + scale * (y - middle[1]), Y = (x, y) => high / 2 - scale * (x - middle[0]);
  if (tank) {
    c.fillStyle = colours.beyond; c.fillRect(0, 0, wide, high);
    path(c, [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => turned(tank[2] + a * tank[0] / 2, tank[3] + b * tank[1] / 2, course, x0, y0)), X, Y);
    c.fillStyle = colours.water; c.fill(); c.strokeStyle = colours.soft; c.lineWidth = 2; c.stroke(); c.save(); c.clip();
  } else c.save();
  grid(c, wide, high, middle, X, Y);
  c.beginPath();
  track.forEach(([x, y], i) => i ? c.lineTo(X(x, y), Y(x, y)) : c.moveTo(X(x, y), Y(x, y)));
  c.lineTo(X(frame.x, frame.y), Y(frame.x, frame.y));
  c.strokeStyle = colours.track; c.lineWidth = 2; c.lineJoin = "round"; c.globalAlpha = 0.7; c.stroke(); c.globalAlpha = 1;
  c.restore();
  const at = (x, y) => { const p = turned(x, y, frame.psi, frame.x, frame.y); return [X(...p), Y(...p)]; };
  path(c, hello.outline, (x, y) => at(x, y)[0], (x, y) => at(x, y)[1]);
  c.fillStyle = colours.hull; c.fill(); c.strokeStyle = frame.contacts ? colours.thrust : colours.edge; c.lineWidth = frame.contacts ? 4 : 1.5; c.stroke();
  hello.thrusters.forEach((t, i) => {
    const [push, angle] = frame.thrusts[i], long = hello.reach * push;
    arrow(c, at(t.x, t.y), at(t.x + long * Math.cos(angle), t.y + long * Math.sin(angle)), colours.thrust, 3);
    const leg = 0.12 * hello.length, [ax, ay] = at(t.x, t.y), [bx, by] = at(t.x - leg * Math.cos(angle), t.y - leg * Math.sin(angle));
    c.beginPath(); c.moveTo(ax, ay); c.lineTo(bx, by); c.strokeStyle = colours.ink; c.lineWidth = 4; c.stroke();
  });
  rose(c, wide, frame);
  bar(c, high);
}

const turned = (x, y, psi, x0, y0) => [x0 + x * Math.cos(psi) - y * Math.sin(psi), y0 + x * Math.sin(psi) + y * Math.cos(psi)];

function path(c, points, X, Y) {
  c.beginPath();
  points.forEach(([x, y], i) => i ? c.lineTo(X(x, y), Y(x, y)) : c.moveTo(X(x, y), Y(x, y)));
  c.closePath();
}

function round(length) {  // 1, 2 or 5 times a power of ten, at most
  const ten = 10 ** Math.floor(Math.log10(length));
  return ten * [5, 2, 1].find(n => n * ten <= length * 1.0001);
}

function grid(c, wide, high, middle, X, Y) {
  const step = round(120 / scale), [mx, my] = middle, halfX = high / 2 / scale, halfY = wide / 2 / scale;
  c.strokeStyle = colours.grid; c.lineWidth = 1; c.beginPath();
  for (let y = Math.ceil((my - halfY) / step) * step; y <= my + halfY; y += step) { c.moveTo(X(0, y), 0); c.lineTo(X(0, y), high); }
  for (let x = Math.ceil((mx - halfX) / step) * step; x <= mx + halfX; x += step) { c.moveTo(0, Y(x, 0)); c.lineTo(wide, Y(x, 0)); }
  c.stroke();
}

function arrow(c, [ax, ay], [bx, by], colour, thick) {
  const long = Math.hypot(bx - ax, by - ay);
  if (long < 2) return;
  const head = Math.min(10, 0.6 * long), ux = (bx - ax) / long, uy = (by - ay) / long;
  c.strokeStyle = c.fillStyle = colour; c.lineWidth = thick; c.beginPath(); c.moveTo(ax, ay); c.lineTo(bx - head * ux, by - head * uy); c.stroke();
  c.beginPath(); c.moveTo(bx, by);
  c.lineTo(bx - head * ux - 0.5 * head * uy, by - head * uy + 0.5 * head * ux);
  c.lineTo(bx - head * ux + 0.5 * head * uy, by - head * uy - 0.5 * head * ux);
  c.closePath(); c.fill();
}

function rose(c, wide, frame) {  // where the wind pushes, beside the heading
  const [x, y, r] = [wide - 62, 62, 40];
  c.beginPath(); c.arc(x, y, r, 0, 2 * Math.PI); c.strokeStyle = colours.soft; c.lineWidth = 1; c.stroke();
  c.beginPath(); c.moveTo(x, y - r); c.lineTo(x, y - r + 7); c.stroke();
  const to = (psi, long) => [x + long * Math.sin(psi), y - long * Math.cos(psi)];
  c.font = "12px system-ui, sans-serif"; c.textAlign = "center"; c.fillStyle = colours.ink;
  const degrees = Math.round(((frame.psi * DEG % 360) + 360) % 360);
  c.fillText(`${degrees}°`, x, y + r + 15);
  arrow(c, to(frame.psi + Math.PI, r - 8), to(frame.psi, r - 8), colours.edge, 2);
  if (!frame.wind) return;
  const [wx, wy] = turned(...frame.wind, frame.psi, 0, 0), force = Math.hypot(wx, wy), psi = Math.atan2(wy, wx);
  if (force > 0) arrow(c, to(psi + Math.PI, r - 3), to(psi, r - 3), colours.wind, 4);
  c.fillStyle = colours.wind; c.fillText(`wind ${force.toPrecision(2)} N`, x, y + r + 31);
}

function bar(c, high) {
  const long = round(140 / scale), x = 16, y = high - 18;
  c.strokeStyle = colours.ink; c.lineWidth = 2; c.beginPath(); c.moveTo(x, y - 5); c.lineTo(x, y); c.lineTo(x + long * scale, y); c.lineTo(x + long * scale, y - 5); c.stroke();
  c.font = "12px system-ui, sans-serif"; c.textAlign = "left"; c.fillStyle = colours.ink; c.fillText(`${long} m`, x + 5, y - 6);
}

const zoom = by => { scale *= by; dirty = true; };
$("in").onclick = () => zoom(1.3);
$("out").onclick = () => zoom(1 / 1.3);
$("sea").addEventListener("wheel", e => { e.preventDefault(); zoom(Math.exp(-0.001 * e.deltaY)); }, { passive: false });
addEventListener("resize", () => { dirty = true; });

function tick() {
  poll();
  if (hello && !hello.ready) preparing();
  if (dirty && hello) {
    dirty = false;
    pads();
    if (frame) figures();
    draw(frame || atStart());
  }
  requestAnimationFrame(tick);
}
function start() {
  paint();
  word();
  setInterval(poll, 50);  // where the browser draws less often
  requestAnimationFrame(tick);
}
