"use strict";
// The page of `gears live`: tells the server what is changed, and draws what it answers.
const element = id => document.getElementById(id);
const GREY = "#8A949E";
const QUIET = { displaylogo: false, responsive: true, displayModeBar: "hover", modeBarButtonsToRemove: ["lasso2d", "select2d", "toggleSpikelines"] };
// For tests and the curious: what was drawn last.
const live = window.live = { number: 0, drawn: 0, state: null, result: null, start: null, connected: false };
let socket = null;

// The connection, which is made again when it was lost: the server keeps everything.
const connect = () => {
  socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}${location.pathname}socket`);
  socket.onopen = () => { live.connected = true; trouble(""); };
  socket.onmessage = event => { const message = JSON.parse(event.data); told[message.kind]?.(message); };
  socket.onclose = () => {
    live.connected = false;
    say("not connected");
    trouble("The connection to the program is lost. It comes back by itself while `gears live` runs; otherwise start it again and open its new address.");
    setTimeout(connect, 1000);
  };
};
const ask = message => { if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message)); };

const say = (words, done = 0, total = 0) => {
  element("words").textContent = words;
  element("status").classList.toggle("busy", total >= 0 && words !== "ready");
  const bar = element("progress");
  bar.hidden = !(total > 0);
  if (total > 0) { bar.max = total; bar.value = done; }
};
const trouble = words => { element("trouble").textContent = words; element("trouble").hidden = !words; };

const told = {
  state: message => {
    live.state = message;
    live.number = message.number;
    element("title").textContent = document.title = message.title;
    element("undo").disabled = !message.undo;
    element("redo").disabled = !message.redo;
    element("start").disabled = element("compare").disabled = !message.changed;
    element("python").querySelector("pre").textContent = message.python;
    fields(message);
    if (message.problems.length) say("a mistake: the result is of the scene before");
  },
  progress: message => {
    if (message.number === live.number) say(STAGES[message.stage] || message.stage || "computing", message.done, message.total);
  },
  start: message => { live.start = message.result; if (live.result) draw(live.result); },
  result: message => {
    live.result = message;
    trouble("");
    draw(message);
    live.drawn = message.number;
    say(message.first_look ? "a first look with few steps; all steps follow" : "ready");
  },
  failed: message => { say("failed"); trouble(message.message); },
  left: () => {},
  names: message => element("names").replaceChildren(...message.names.map(name => new Option(name, name))),
  unknown: message => { element("unknown").textContent = message.message; element("unknown").hidden = false; },
};

// What the program calls its stages, where a designer would not.
const STAGES = { march: "solving the steps", compile: "compiling", "propose lead modifications": "looking for a better crowning" };

// Fields: one element each, kept while the page lives, so that a slider that is being moved stays in the hand.
const known = new Map();
const fields = state => {
  const wrong = new Map(state.problems.map(each => [each.path, each.message]));
  for (const control of state.controls) {
    if (!known.has(control.name)) known.set(control.name, made(control));
    known.get(control.name)(control, wrong.get(control.name) || "");
  }
  const general = wrong.get("");
  if (general) trouble(general);
};
const made = control => {
  const parent = group(control.group), field = document.createElement("div");
  field.className = "field";
  const label = document.createElement("label"), row = document.createElement("div");
  const slider = document.createElement("input"), text = document.createElement("input"), mistake = document.createElement("p");
  label.textContent = control.unit ? `${control.label} (${control.unit})` : control.label;
  text.id = label.htmlFor = `field ${control.name}`;
  label.title = text.title = `${control.name}: ${control.said}`;
  slider.type = "range";
  slider.setAttribute("aria-label", control.label);
  slider.dataset.name = text.dataset.name = control.name;
  text.spellcheck = false;
  row.className = "row";
  mistake.className = "mistake";
  row.append(slider, text);
  field.append(label, row, mistake);
  parent.append(field);
  slider.oninput = () => { text.value = shown(Number(slider.value), control.unit); send(control.name, Number(slider.value)); };
  text.onchange = () => send(control.name, text.value);
  return (now, wrong) => {
    slider.min = now.lowest; slider.max = now.highest; slider.step = now.step;
    slider.style.visibility = now.slides ? "visible" : "hidden";
    if (document.activeElement !== slider && now.number !== null) slider.value = now.number;
    if (document.activeElement !== text && !(wrong && text.value)) text.value = now.text || (now.number === 0 ? "none" : "");
    field.classList.toggle("changed", now.text !== now.start);
    label.dataset.start = now.start || "none";
    field.classList.toggle("wrong", Boolean(wrong));
    mistake.textContent = wrong;
  };
};
const group = name => {
  let found = document.querySelector(`fieldset[data-name="${name}"]`);
  if (found) return found;
  found = document.createElement("fieldset");
  found.dataset.name = name;
  const legend = document.createElement("legend");
  legend.textContent = name;
  found.append(legend);
  element("controls").insertBefore(found, element("more"));
  return found;
};
const shown = (number, unit) => `${Number(number.toPrecision(6))}${unit ? " " + unit : ""}`;
// A slider that is moved asks no more often than the screen is drawn.
const waiting = new Map();
const send = (name, value) => {
  if (!waiting.size) requestAnimationFrame(() => {
    for (const [each, last] of waiting) ask({ do: "set", name: each, value: last });
    waiting.clear();
  });
  waiting.set(name, value);
};

// Charts: lines of the start lie below in grey.
const plots = new Map();
const draw = result => {
  const start = live.start === null || live.start.number === result.number ? null : live.start;
  for (const chart of result.charts) {
    if (!plots.has(chart.name)) plots.set(chart.name, frame(chart.name));
    const { figure, plot } = plots.get(chart.name);
    figure.hidden = false;
    figure.querySelector("figcaption").textContent = chart.caption;
    figure.querySelector(".note").textContent = chart.note;
    const before = start?.charts.find(each => each.name === chart.name);
    const lines = before ? before.figure.data.filter(trace => ["scatter", "bar", undefined].includes(trace.type)) : [];
    const old = lines.map(trace => ({ ...trace, name: "start", showlegend: false, hoverinfo: "skip", line: { ...trace.line, color: GREY, width: 1.2 }, marker: { ...trace.marker, color: GREY } }));
    const layout = { ...chart.figure.layout, height: Math.min(chart.height, 320), uirevision: "kept", barmode: "group" };
    // Both have to be seen; curves that are far apart would both be flat, so those of the start come nearer.
    const range = layout.yaxis?.range, by = old.length ? moved(layout.yaxis, before.figure.layout.yaxis?.range) : 0;
    if (old.length && layout.yaxis) layout.yaxis = { ...layout.yaxis, range: both(range, before.figure.layout.yaxis?.range?.map(end => end + by)) };
    if (by) {
      for (const trace of old) trace.y = trace.y.map(value => value === null ? null : value + by);
      const unit = /\((.*)\)/.exec(layout.yaxis.title.text)?.[1] || "";
      figure.querySelector(".note").textContent += ` The grey curve of the start is moved by ${by.toPrecision(3)} ${unit}.`;
    }
    Plotly.react(plot, [...old, ...chart.figure.data], layout, QUIET);
  }
  const there = new Set(result.charts.map(chart => chart.name));
  for (const [name, { figure }] of plots) figure.hidden = !there.has(name);
  element("flank").hidden = !result.tooth;
  if (result.tooth) Plotly.react(element("tooth"), result.tooth.data, { ...result.tooth.layout, uirevision: "kept" }, QUIET);
  numbers(result, start);
  element("warnings").replaceChildren(...result.warnings.map(words => { const item = document.createElement("li"); item.textContent = words; return item; }));
  turning.pair = result.drawing;
  if (!turning.on) paint();
};
const moved = (axis, other) => {
  const own = axis?.range;
  if (!own || !other || axis.type === "log" || own[0] <= other[1] && other[0] <= own[1]) return 0;
  return (own[0] + own[1] - other[0] - other[1]) / 2;
};
const both = (one, other) => one && other ? [Math.min(one[0], other[0]), Math.max(one[1], other[1])] : one;
const frame = name => {
  const figure = document.createElement("figure"), plot = document.createElement("div"), note = document.createElement("p");
  figure.append(document.createElement("figcaption"), plot, note);
  figure.dataset.name = name;
  note.className = "note";
  element("charts").append(figure);
  return { figure, plot };
};
const numbers = (result, start) => {
  const before = new Map(start ? start.numbers : []);
  element("numbers").tBodies[0].replaceChildren(...result.numbers.map(([label, now]) => {
    const row = document.createElement("tr"), old = before.get(label) || "";
    for (const words of [label, now, old === now ? "" : old]) row.insertCell().textContent = words.replace(/\bum\b/g, "µm");
    row.cells[1].classList.toggle("changed", Boolean(start) && old !== now);
    return row;
  }));
};

// The gears to scale, turning a mesh cycle in two seconds.
const turning = { on: true, phase: 0, pair: null, last: 0 };
const FILLS = ["#DCE9F3", "#F3E6DA"];
const paint = () => {
  const canvas = element("drawing"), pair = turning.pair, ratio = devicePixelRatio || 1;
  if (!pair || !canvas.clientWidth) return;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  const context = canvas.getContext("2d"), [left, right, bottom, top] = pair.ends;
  const scale = 0.96 * Math.min(canvas.height / (top - bottom), canvas.width / (right - left));
  context.setTransform(scale, 0, 0, -scale, (canvas.width - scale * (left + right)) / 2, (canvas.height + scale * (top + bottom)) / 2);
  // Of a planetary set all is seen from its carrier, which turns.
  context.rotate(pair.turn * turning.phase);
  context.lineWidth = 1.1 * ratio / scale;
  context.strokeStyle = "#222222";
  pair.gears.forEach((gear, number) => {
    const angle = gear.turn * turning.phase, cosine = Math.cos(angle), sine = Math.sin(angle), [x0, y0] = gear.centre;
    context.beginPath();
    for (const [x, y] of gear.outline) context.lineTo(x0 + cosine * (x - x0) - sine * (y - y0), y0 + sine * (x - x0) + cosine * (y - y0));
    context.closePath();
    context.moveTo(x0 + gear.bore, y0);
    context.arc(x0, y0, gear.bore, 0, 2 * Math.PI);
    context.fillStyle = FILLS[number % FILLS.length];
    context.fill("evenodd");
    context.stroke();
  });
};
const tick = now => {
  if (turning.on && !document.hidden) {
    turning.phase += Math.min(now - turning.last, 100) / 2000;
    paint();
  }
  turning.last = now;
  requestAnimationFrame(tick);
};

for (const name of ["undo", "redo", "start", "compare"]) element(name).onclick = () => ask({ do: name });
element("lines").onclick = () => element("python").showModal();
element("turn").onclick = () => {
  turning.on = !turning.on;
  element("turn").textContent = turning.on ? "Stop" : "Turn";
  element("turn").setAttribute("aria-pressed", turning.on);
};
element("more").onsubmit = event => {
  event.preventDefault();
  element("unknown").hidden = true;
  ask({ do: "show", name: element("name").value.trim() });
};
addEventListener("keydown", event => {
  if (!(event.ctrlKey || event.metaKey) || event.target.matches("input:not([type=range])")) return;
  if (event.key === "z") { event.preventDefault(); ask({ do: event.shiftKey ? "redo" : "undo" }); }
  if (event.key === "y") { event.preventDefault(); ask({ do: "redo" }); }
});
addEventListener("load", () => { connect(); requestAnimationFrame(tick); });
