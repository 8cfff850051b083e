// Repeats free runs in the browser while sliders move. `loader.js`, which comes before this script, loads the program.
(() => {
const STEPS = 1000; // positions of a slider
const root = document.getElementById("what-if");
const $ = selector => root.querySelector(selector);

// The content of the page --------------------------------------------------------------------------------------------

// A recording in the memory of its own instance of the program
class Simulation {
  constructor(model, recording, numbers, exports) {
    Object.assign(this, { model, recording, numbers, exports, size: 2 * model.nq });
    const { times, command_times, commands, values, states, starts } = recording;
    this.rows = times[1];
    const put = array => putNumbers(exports, array);
    this.at = {
      times: put(numbers(times)), commandTimes: put(numbers(command_times)),
      commands: put(numbers(commands)), states: put(numbers(states)),
      values: put(numbers(values)), switches: put(new Float64Array(model.switches)),
      starts: exports.allocate(8 * starts.length), ends: exports.allocate(8 * starts.length),
      out: exports.allocate(8 * starts.length * this.rows * this.size),
    };
    this.times = numbers(times);
    this.measured = Object.fromEntries(Object.entries(recording.measured).map(([name, place]) => [name, numbers(place)]));
  }
  // Simulate with parameter values and switches, in runs of the usual length or in one run; returns a list of runs.
  run(values, switches, whole) {
    const { exports, at, rows, size, recording, model } = this;
    const starts = whole ? [0] : recording.starts, ends = whole ? [rows - 1] : recording.ends;
    new Float64Array(exports.memory.buffer, at.values, values.length).set(values);
    new Float64Array(exports.memory.buffer, at.switches, switches.length).set(switches);
    new BigInt64Array(exports.memory.buffer, at.starts, starts.length).set(starts.map(BigInt));
    new BigInt64Array(exports.memory.buffer, at.ends, ends.length).set(ends.map(BigInt));
    exports.simulate(rows, at.times, recording.command_times[1], at.commandTimes, at.commands, model.max_step,
      at.values, at.switches, starts.length, at.starts, at.ends, at.states, at.out);
    const out = new Float64Array(exports.memory.buffer, at.out, starts.length * rows * size);
    return starts.map((first, j) => {
      const last = ends[j], channels = {};
      for (const [name, code] of Object.entries(model.signals)) {
        const column = new Float64Array(last - first + 1);
        for (let i = first; i <= last; i++) column[i - first] = out[(j * rows + i) * size + code];
        for (const drift of recording.drifts) {
          if (code >= model.nq || !switches[drift.switch]) continue;
          for (let i = first; i <= last; i++)
            column[i - first] += drift.offsets[j][code] * Math.exp(-(this.times[i] - this.times[first]) / values[drift.time]);
        }
        channels[name] = column;
      }
      return { first, last, channels };
    });
  }
}

// The state of the sliders -------------------------------------------------------------------------------------------

// Parameter values and switches of the program for a recording, as a diagnosis writes them.
function programInputs(model, recording, nominal, state) {
  const values = Float64Array.from(nominal), switches = Float64Array.from(model.switches);
  const write = grouped => model.effects.forEach((effect, e) => {
    if (!state[e].acts) return;
    effect.parameters.forEach((parameter, k) => {
      if (Boolean(parameter.group) !== grouped || grouped && !recording.groups.includes(parameter.group)) return;
      const x = state[e].values[k];
      parameter.at.forEach((at, i) => {
        if (parameter.how === "scales") values[at] *= x;
        else if (parameter.how === "shifts") values[at] += parameter.weights[i] * x;
        else values[at] = x;
      });
    });
  });
  write(false);
  write(true);
  model.effects.forEach((effect, e) => { if (effect.switch >= 0 && state[e].acts) switches[effect.switch] = 1; });
  for (const [to, from] of model.links) values[to] = values[from];
  return [values, switches];
}
// "found": the corrected vessel; "file": the vessel as its file has it.
function preset(model, name) {
  return model.effects.map(effect => ({
    acts: effect.coefficients || name === "found" && effect.found,
    values: effect.parameters.map(p => name === "file" && effect.coefficients ? p.off : p.found),
  }));
}
const sameState = (a, b) => JSON.stringify(a) === JSON.stringify(b);
function rms(runs, simulation, signals) {
  let sum = 0, count = 0;
  for (const { first, channels } of runs)
    for (const name of signals) {
      const recorded = simulation.measured[name];
      if (!recorded) continue;
      channels[name].forEach((x, i) => {
        const off = x - recorded[first + i];
        if (Number.isNaN(recorded[first + i])) return;
        sum += off * off;
        count++;
      });
    }
  return Math.sqrt(sum / count);
}
function formatted(value, unit) {
  if (!Number.isFinite(value)) return "diverges";
  const digits = value === 0 ? 0 : Math.max(0, Math.min(6, 2 - Math.floor(Math.log10(Math.abs(value)))));
  return value.toFixed(digits).replace(/^-(?=[0.]*$)/, "").replace("-", "\u2212") + (unit.startsWith("\u00b0") || !unit ? "" : "\u00a0") + unit;
}
// A value with its most convenient unit: [smallest size, name, value per SI unit], the largest unit first.
function shown(value, { units }) {
  const [, unit, factor] = units.find(([least]) => Math.abs(value) >= least) || units[units.length - 1];
  return formatted(value * factor, unit);
}

// Drawings -----------------------------------------------------------------------------------------------------------

const colours = new Map(); // of the style, read once for each colour scheme
function colour(name) {
  if (!colours.has(name)) colours.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  return colours.get(name);
}
// A drawing with equal scales (a track) or free ones (a signal over time). Lines: [look, xs, ys].
function draw(canvas, lines, equal, titles) {
  const ratio = window.devicePixelRatio || 1, [wide, high] = canvas.size || [canvas.clientWidth, canvas.clientHeight];
  const pixels = [Math.round(wide * ratio), Math.round(high * ratio)];
  if (canvas.width !== pixels[0] || canvas.height !== pixels[1]) [canvas.width, canvas.height] = pixels;
  const pen = canvas.getContext("2d"), ghost = lines.filter(line => line[0] === "--recorded");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, wide, high);
  let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
  for (const [, xs, ys] of ghost.length ? ghost : lines)
    xs.forEach((x, i) => {
      if (!Number.isFinite(x) || !Number.isFinite(ys[i])) return;
      [x0, x1, y0, y1] = [Math.min(x0, x), Math.max(x1, x), Math.min(y0, ys[i]), Math.max(y1, ys[i])];
    });
  if (!(x1 >= x0)) return;
  const left = 46, bottom = 22, room = equal ? 0.6 : 0;
  const pad = (a, b) => (b - a || 1) * room;
  [x0, x1] = [x0 - pad(x0, x1), x1 + pad(x0, x1)];
  const margin = (y1 - y0 || 1) * (equal ? room : 0.25);
  [y0, y1] = [y0 - margin, y1 + margin];
  let sx = (wide - left - 8) / (x1 - x0 || 1), sy = (high - bottom - 8) / (y1 - y0);
  if (equal) {
    sx = sy = Math.min(sx, sy);
    const more = [(wide - left - 8) / sx - (x1 - x0), (high - bottom - 8) / sy - (y1 - y0)];
    [x0, x1, y0, y1] = [x0 - more[0] / 2, x1 + more[0] / 2, y0 - more[1] / 2, y1 + more[1] / 2];
  }
  const px = x => left + (x - x0) * sx, py = y => high - bottom - (y - y0) * sy;
  pen.font = "11px system-ui, sans-serif";
  pen.lineWidth = 1;
  pen.fillStyle = colour("--soft");
  pen.strokeStyle = colour("--rule");
  const spacing = (length, count) => {
    const raw = length / count, power = 10 ** Math.floor(Math.log10(raw));
    return [1, 2, 5, 10].find(k => k * power >= raw) * power;
  };
  const label = (v, step) => v.toFixed(Math.max(0, -Math.floor(Math.log10(step)))).replace("-", "\u2212");
  pen.textAlign = "center";
  for (let step = spacing(x1 - x0, Math.max(2, wide / 90)), x = Math.ceil(x0 / step) * step; x <= x1; x += step) {
    pen.beginPath(); pen.moveTo(px(x), 8); pen.lineTo(px(x), high - bottom); pen.stroke();
    pen.fillText(label(x, step), px(x), high - bottom + 14);
  }
  pen.textAlign = "right";
  for (let step = spacing(y1 - y0, Math.max(2, high / 60)), y = Math.ceil(y0 / step) * step; y <= y1; y += step) {
    pen.beginPath(); pen.moveTo(left, py(y)); pen.lineTo(wide - 8, py(y)); pen.stroke();
    pen.fillText(label(y, step), left - 5, py(y) + 4);
  }
  pen.fillText(titles[0], wide - 8, high - bottom - 5);
  pen.save();
  pen.beginPath(); pen.rect(left, 8, wide - left - 8, high - bottom - 8); pen.clip();
  for (const [look, xs, ys] of lines) {
    pen.strokeStyle = colour(look);
    pen.lineWidth = look === "--recorded" ? 5 : 2;
    pen.lineJoin = "round";
    pen.beginPath();
    let down = false;
    xs.forEach((x, i) => {
      const there = Number.isFinite(x) && Number.isFinite(ys[i]);
      if (there && down) pen.lineTo(px(x), py(ys[i]));
      else if (there) pen.moveTo(px(x), py(ys[i]));
      down = there || look === "--recorded" && down; // position fixes may be rarer than rows
    });
    pen.stroke();
  }
  pen.restore();
}

// The controls -------------------------------------------------------------------------------------------------------

function setText(place, text) { // writing the same text would make the browser lay out the page again
  if (place.textContent !== text) place.textContent = text;
}
function element(kind, properties, ...children) {
  const created = Object.assign(document.createElement(kind), properties);
  created.append(...children);
  return created;
}

function build(model, simulations) {
  let state = preset(model, "found"), dirty = true, runs = [];
  const rows = []; // of controls, one for each effect
  const chosen = () => simulations[Number($("#what-if-recording").value)];
  const whole = () => $("#what-if-length").value === "whole";
  const runsOf = (one, given) => chosen().run(...programInputs(model, chosen().recording, chosen().numbers(chosen().recording.values), given), whole());

  function effectControls(effect, e) {
    const box = element("fieldset", { className: "effect" }), own = { sliders: [] };
    const title = element("span", { textContent: effect.name });
    const legend = element("legend", {}, title);
    if (!effect.coefficients && effect.parameters.length) {
      own.check = element("input", { type: "checkbox" });
      own.check.addEventListener("change", () => { state[e].acts = own.check.checked; changed(); });
      legend.replaceChildren(element("label", {}, own.check, title));
    }
    box.append(legend);
    if (effect.words) box.append(element("p", { className: "about", textContent: effect.words }));
    effect.parameters.forEach((parameter, k) => {
      const input = element("input", { type: "range", min: 0, max: STEPS, step: 1 }), value = element("output", {});
      input.addEventListener("input", () => {
        state[e].values[k] = parameter.low + (parameter.high - parameter.low) * Number(input.value) / STEPS;
        state[e].acts = true;
        changed();
      });
      box.append(element("label", { className: "slider" }, element("span", { textContent: parameter.words }), input, value));
      own.sliders.push({ input, value, parameter });
    });
    rows[e] = own;
    return box;
  }
  function showState() {
    rows.forEach((own, e) => {
      if (own.check) own.check.checked = state[e].acts;
      own.sliders.forEach(({ input, value, parameter }, k) => {
        const x = state[e].values[k], place = Math.round(STEPS * (x - parameter.low) / (parameter.high - parameter.low || 1));
        if (Number(input.value) !== place) input.value = place;
        const text = state[e].acts ? shown(x, parameter) : "off";
        if (value.textContent === text) return;
        value.textContent = text;
        input.setAttribute("aria-valuetext", text);
      });
    });
    for (const button of root.querySelectorAll(".presets button")) {
      const pressed = String(sameState(state, button.state));
      if (button.getAttribute("aria-pressed") !== pressed) button.setAttribute("aria-pressed", pressed);
    }
  }
  function errorsOf(given) {
    const found = runsOf(chosen(), given);
    return model.families.map(family => rms(found, chosen(), family.signals));
  }
  function showReferences() {
    ["found", "file"].forEach((name, i) => errorsOf(preset(model, name)).forEach((x, f) => {
      $("tbody").rows[f].cells[2 + i].textContent = shown(x, model.families[f]);
    }));
  }
  function showRuns() {
    const one = chosen(), { measured, times } = one;
    model.families.forEach((family, f) => setText($("tbody").rows[f].cells[1], shown(rms(runs, one, family.signals), family)));
    const line = (name, factor = 1) => [measured[name].map(x => x * factor), joined(runs.map(run => run.channels[name].map(x => x * factor)))];
    const t = joined(runs.map(run => times.subarray(run.first, run.last + 1)));
    for (const canvas of root.querySelectorAll("canvas")) {
      if (canvas.dataset.signal) {
        const quantity = model.quantities[canvas.dataset.signal], [ghost, now] = line(canvas.dataset.signal, quantity.factor);
        draw(canvas, [["--recorded", times, ghost], ["--patched", t, now]], false, ["time [s]"]);
      } else {
        const [north, x] = line("x_m"), [east, y] = line("y_m");
        draw(canvas, [["--recorded", east, north], ["--patched", y, x]], true, ["east [m]"]);
      }
    }
  }
  function joined(parts) { // with a gap between two runs
    return parts.flatMap(part => [...part, NaN]);
  }
  function update() {
    dirty = false;
    runs = runsOf(chosen(), state);
    showState();
    showRuns();
  }
  function announce() {
    const errors = [...$("tbody").rows].map(row => `${row.cells[0].textContent} ${row.cells[1].textContent}`);
    $("[role=status]").textContent = `Error now: ${errors.join(", ")}`;
  }
  function changed() {
    if (dirty) return;
    dirty = true;
    requestAnimationFrame(update);
  }
  function renew() { showReferences(); changed(); }

  const presets = [["As found", preset(model, "found")], ["As in the file", preset(model, "file")]];
  model.effects.forEach((effect, e) => {
    if (!effect.found || effect.coefficients || !effect.parameters.length) return;
    const without = preset(model, "found");
    without[e].acts = false;
    presets.push([`Without ${effect.name}`, without]);
  });
  for (const [words, given] of presets) {
    const button = element("button", { type: "button", textContent: words, state: given });
    button.addEventListener("click", () => { state = structuredClone(given); changed(); requestAnimationFrame(announce); });
    $(".presets").append(button);
  }
  model.effects.forEach((effect, e) => {
    const place = effect.coefficients ? ".coefficients" : effect.found ? ".found" : ".others";
    $(place).append(effectControls(effect, e));
  });
  simulations.forEach((one, i) => $("#what-if-recording").append(element("option", { value: i, textContent: one.recording.name })));
  $("#what-if-recording").addEventListener("change", renew);
  $("#what-if-length").addEventListener("change", renew);
  $(".panel").addEventListener("change", () => requestAnimationFrame(announce));
  const sizes = new ResizeObserver(entries => {
    for (const { target, contentRect } of entries) target.size = [contentRect.width, contentRect.height];
    changed();
  });
  root.querySelectorAll("canvas").forEach(canvas => sizes.observe(canvas));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { colours.clear(); changed(); });
  $(".panel").hidden = false;
  showReferences();
  update();
  // For the console and for tests
  root.whatIf = { model, simulations, update, get runs() { return runs; }, get state() { return state; } };
  announce();
}

async function start() {
  const model = JSON.parse($("script[type='application/json']").textContent);
  const buffer = await unpackNumbers($("script[type='text/plain']").textContent);
  const program = await compileProgram(buffer, model.program);
  const numbers = ([offset, count]) => new Float64Array(buffer, offset, count);
  const simulations = await Promise.all(model.recordings.map(async recording => {
    return new Simulation(model, recording, numbers, await startProgram(program));
  }));
  build(model, simulations);
}
start().catch(error => { $("[role=status]").textContent = `This browser cannot run the vessel's program: ${error.message}`; });
})();
