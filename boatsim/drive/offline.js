"use strict";
// The boat in the page: the vessel's compiled program is stepped here, and what was driven is kept for a download.
const BEHIND = 0.25;  // [s] of real time that the simulation catches up on; the rest is passed over
const NOTICE = 6;  // [s] for which a message is shown
const DIGITS = 12;  // of a number in the recording, as `boatsim run` writes it
let model, boat, due, logDue, begun;  // the simulation, the times [s] of the next control and the next row, and the date
let away = "", rows = [], goals = [];  // why nobody drives, rows of the recording, and commands of the sticks by time
let unsaved = false;  // whether anything was driven that has not been saved

const inMiddle = () => Math.max(...sticks.map(Math.abs)) <= model.dead;
const trouble = () => !hello ? "The page is being loaded …" : frame ? "" : "Sticks to the middle to begin.";
const showTiming = () => {};

// The vessel's program -----------------------------------------------------------------------------------------------

class Boat {
  constructor(model, numbers, exports) {
    Object.assign(this, { exports, model });
    this.initial = Object.fromEntries(Object.entries(model.arrays).map(([name, place]) => [name, numbers(place)]));
    this.at = Object.fromEntries(Object.entries(this.initial).map(([name, array]) => [name, putNumbers(exports, array)]));
    this.observed = exports.allocate(8 * model.observed.length);
    exports.place_boat(...model.order.map(name => this.at[name]));
    if (model.wind) exports.place_wind(...model.wind.map(place => putNumbers(exports, numbers(place))));
  }
  view(at, count) { return new Float64Array(this.exports.memory.buffer, at, count); }
  array(name) { return this.view(this.at[name], this.initial[name].length); }
  reset() { for (const [name, values] of Object.entries(this.initial)) this.array(name).set(values); }
  get time() { return this.array("t")[0]; }
  advance() { this.exports.advance(this.model.step, this.at.actuators); }
  observe() {
    this.exports.observe(this.observed);
    return [...this.view(this.observed, this.model.observed.length)];
  }
}

// Sticks and commands ------------------------------------------------------------------------------------------------

function beyondDeadZone(deflection) {
  const way = model.steps * Math.min(Math.max(Math.abs(deflection) - model.dead, 0) / (1 - model.dead), 1);
  const whole = Math.round(way);
  return (way % 1 === 0.5 && whole % 2 ? whole - 1 : whole) / model.steps * Math.sign(deflection);
}

// Commands of the channels that the sticks set, at deflections of the sticks
function commandsOf(deflections) {
  const commands = { ...model.neutral };
  for (const { key, stick, low, high } of model.dials) {
    const way = beyondDeadZone(deflections[AXES.indexOf(stick)]);
    commands[key] += way > 0 ? way * high : -way * low;
  }
  for (const [key, x] of Object.entries(commands)) {
    const [low, high] = model.limits[key];
    commands[key] = Number(Math.min(Math.max(x, low), high).toFixed(model.digits));
  }
  return commands;
}

function control() {
  const goal = away ? null : commandsOf(sticks), t = boat.time;
  unsaved = unsaved || !away && sticks.some(x => beyondDeadZone(x));
  if (!goals.length || JSON.stringify(goal) !== JSON.stringify(goals[goals.length - 1][1])) goals.push([t, goal]);
  boat.sent = model.channels.map(({ name, neutral }) => goal && name in goal ? goal[name] : neutral);
  boat.array("commands").set(boat.sent.map((x, i) => Math.min(Math.max(x, model.channels[i].low), model.channels[i].high)));
}

function handOver(changed) {
  if (model && inMiddle()) away = "";
  return changed;
}

// Time ---------------------------------------------------------------------------------------------------------------

// The boat at its start; the run begins when the sticks are in the middle.
function restart() {
  boat.reset();
  [away, over, rows, goals, unsaved] = ["no driver has taken the sticks", "", [], [], false];
  [frame, track, past] = [null, [], []];
  [due, logDue, begun] = [model.period, 0, new Date()];
  dirty = true;
  announce("");
}

// Advance the boat to the present. While the page is hidden, the simulation pauses.
let origin = 0;  // [ms] of the page's clock at simulated time 0
function proceed() {
  if (document.hidden || over || away && !rows.length) return;
  if (!rows.length) {
    control();
    keepRow();
  }
  const now = performance.now();
  if (now - origin - 1000 * boat.time > 1000 * BEHIND) origin = now - 1000 * boat.time;
  while (!over && boat.time + model.step <= (now - origin) / 1000) step();
  show();
}

function step() {
  boat.advance();
  if (boat.time >= due - model.tolerance) {
    due += model.period;
    control();
  }
  if (boat.time >= model.duration - model.tolerance)
    over = `The run has ended after ${boat.time.toFixed(0)} s. Save it, or start again.`;
  if (over || boat.time >= logDue - model.tolerance) keepRow();
}

function keepRow() {
  if (boat.time >= logDue - model.tolerance) logDue += model.log;
  const observed = boat.observe(), motion = model.motion.map(i => observed[i]);
  const row = [boat.time, ...motion, ...boat.array("commands"), ...boat.sent, ...boat.array("actuators"),
    ...model.forces.map(i => observed[i])];
  if (!motion.every(Number.isFinite)) over = `The motion is no longer finite at ${boat.time.toFixed(1)} s. Start again.`;
  else rows.push(Float64Array.from(row));
}

function show() {
  const observed = boat.observe(), value = name => observed[model.observed.indexOf(name)] ?? 0;
  const [x, y, psi] = ["x", "y", "psi"].map(value), wind = model.wind ? ["wind_X_N", "wind_Y_N"].map(value) : null;
  if (!Number.isFinite(x + y + psi)) { word(); return; }
  const commands = boat.array("commands"), actuators = boat.array("actuators");
  const channel = name => model.channels.findIndex(one => one.name === name);
  take({ t: boat.time, x, y, psi, wind, contacts: 0, norms: {}, away,
    goals: hello.dials.map(({ key }) => [boat.sent[channel(key)], commands[channel(key)]]),
    thrusts: model.arrows.map(places => places.map(i => i < 0 ? 0 : actuators[i])) });
}

document.addEventListener("visibilitychange", () => { if (document.hidden) away = "page hidden"; });

// Files --------------------------------------------------------------------------------------------------------------

let noticeTimer = 0;  // timer of the notice
function announce(words) {
  clearTimeout(noticeTimer);
  notice = words;
  if (words) noticeTimer = setTimeout(() => announce(""), 1000 * NOTICE);
  word();
}

function save(suffix, parts, words) {
  const pad = x => String(x).padStart(2, "0"), at = begun;
  const when = `${at.getFullYear()}${pad(at.getMonth() + 1)}${pad(at.getDate())}-${pad(at.getHours())}${pad(at.getMinutes())}${pad(at.getSeconds())}`;
  const name = `${hello.vessel}-drive-${when}.${suffix}`, address = URL.createObjectURL(new Blob(parts, { type: "text/plain" }));
  Object.assign(document.createElement("a"), { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 60000);
  unsaved = false;
  announce(words(name));
}

const recordingText = () => [`${model.columns.join()}\n`, ...rows.map(row => `${Array.from(row, x => Number(x.toPrecision(DIGITS))).join()}\n`)];

function scenarioText() {
  const entry = ([t, goal]) => {
    const values = goal ? Object.entries(goal).map(([key, x]) => `${key} = ${x}`) : [`${model.off} = true`];
    return `  { from = ${Number(t.toFixed(9))}, ${values.join(", ")} },\n`;
  };
  const [top, tables] = model.scenario, last = Number(rows[rows.length - 1][0].toFixed(9));
  return `${top}duration = ${last}\ngoal = [\n${goals.filter(([t]) => t <= last).map(entry).join("")}]\n${tables}`;
}

$("recording").onclick = () => rows.length && save("csv", recordingText(),
  name => `${name} is among your downloads.`);
$("scenario").onclick = () => {
  if (!rows.length || boat.time < model.step) { announce("Nothing has been driven yet."); return; }
  const text = scenarioText();
  if (new Blob([text]).size > model.most_bytes) announce("The commands are too many for a scenario file. The recording contains them.");
  else save("toml", [text], name => `${name} is among your downloads. It repeats this run: boatsim run ${name}`);
};
$("again").onclick = () => { restart(); $("again").blur(); };
addEventListener("beforeunload", e => { if (unsaved) e.preventDefault(); });

// Begin --------------------------------------------------------------------------------------------------------------

async function load() {
  const content = JSON.parse($("model").textContent);
  const buffer = await unpackNumbers($("numbers").textContent);
  const exports = await startProgram(await compileProgram(buffer, content.simulation.program));
  model = content.simulation;
  boat = new Boat(model, ([offset, count]) => new Float64Array(buffer, offset, count), exports);
  begin(content.hello);
  restart();
  const proceedAndRepeat = () => { proceed(); requestAnimationFrame(proceedAndRepeat); };
  proceedAndRepeat();
}
document.body.classList.add("offline");
start();
load().catch(error => { over = `This browser cannot run the vessel's program: ${error.message}`; word(); });
