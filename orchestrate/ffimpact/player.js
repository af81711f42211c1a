// The player of a run. It animates the k3d plot K3DInstance and adds a play button, a slider for
// the time, a choice of the field and a time cursor in the figure. The object `RUN` contains
//   id: id of the mesh; times: times of the states [s]
//   start: index of the state that is shown first; seconds: duration of the animation [s]
//   field: name of the field that is shown first
//   vertices (states, n, 3): positions as uint16 fractions of the box with the corner `low` [m] and
//     the size `extent` [m]
//   fields: name, label and range low ... high of each field, in the unit of its label
//   values (states, n), by name of the field: uint8 fractions of low ... high
//   interfaces: id of the lines between layers, and the vertices of the mesh on them; null without
//   obstacles: id of each obstacle, and its model matrices (states, 16), none if it is at rest
//   cursor: left and right end of the time axis as fractions of the figure's width, and their times
//     start and end [s]
// Each array consists of the compressed differences between successive states.
const world = K3DInstance.getWorld();
const element = (name, attributes = {}) => Object.assign(document.createElement(name), attributes);

function unpacked(text, Kind) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const data = new Kind(fflate.unzlibSync(packed).slice().buffer);
  const size = data.length / RUN.times.length;
  for (let k = size; k < data.length; k++) data[k] += data[k - size];
  return data;
}

const vertices = unpacked(RUN.vertices, Uint16Array);
const shares = {};
for (const { name } of RUN.fields) shares[name] = unpacked(RUN.values[name], Uint8Array);
const n = vertices.length / RUN.times.length / 3;

function places(state) { // deformed positions (n, 3) [m]
  const found = new Float32Array(3 * n);
  for (let k = 0; k < 3 * n; k++)
    found[k] = RUN.low[k % 3] + RUN.extent[k % 3] * vertices[3 * n * state + k] / 65535;
  return { data: found, shape: [n, 3] };
}

function between(placed) { // positions of the vertices between layers
  const { nodes } = RUN.interfaces, found = new Float32Array(3 * nodes.length);
  nodes.forEach((node, k) => found.set(placed.data.subarray(3 * node, 3 * node + 3), 3 * k));
  return { data: found, shape: [nodes.length, 3] };
}

function values(field, state) { // values (n,) of the field, in its unit
  const found = new Float32Array(n);
  for (let k = 0; k < n; k++)
    found[k] = field.low + (field.high - field.low) * shares[field.name][n * state + k] / 255;
  return { data: found, shape: [n] };
}

const controls = element("div", { id: "controls" });
const play = element("button", { id: "play", textContent: "▶", title: "play or stop" });
const slider = element("input", { id: "state", type: "range", min: 0, max: RUN.times.length - 1 });
slider.value = RUN.start;
const choice = element("select", { id: "field", title: "field" });
const clock = element("span", { id: "clock" });
const legend = element("span", { id: "legend" });
for (const { name, label } of RUN.fields)
  choice.append(element("option", { value: name, textContent: label }));
choice.value = RUN.field;
controls.append(play, slider, clock, choice, legend);
document.body.append(controls);

function show() {
  const state = Number(slider.value), t = RUN.times[state];
  const field = RUN.fields.find((one) => one.name === choice.value);
  const json = world.ObjectsListJson[RUN.id];
  const color_range = [field.low, field.high];
  const placed = places(state);
  Object.assign(json, { vertices: placed, attribute: values(field, state), color_range });
  const reloads = [K3DInstance.reload(json, null, true)];
  if (RUN.interfaces) {
    const lines = world.ObjectsListJson[RUN.interfaces.id];
    lines.vertices = between(placed);
    reloads.push(K3DInstance.reload(lines, null, true));
  }
  for (const one of RUN.obstacles) {
    if (one.matrices.length === 0) continue;
    const obstacle = world.ObjectsListJson[one.id];
    obstacle.model_matrix = { data: new Float32Array(one.matrices[state]), shape: [4, 4] };
    reloads.push(K3DInstance.reload(obstacle, null, true));
  }
  Promise.all(reloads).then(() => K3DInstance.render());
  clock.textContent = `${(1e3 * t).toPrecision(4)} ms`;
  legend.innerHTML = `${field.low.toPrecision(3)} <i></i> ${field.high.toPrecision(3)}`;
  const { left, right, start, end } = RUN.cursor;
  const share = Math.min(1, Math.max(0, (t - start) / (end - start)));
  document.getElementById("cursor").style.left = `${100 * (left + (right - left) * share)}%`;
  document.body.dataset.state = state;
}

let timer = null;
function stop() { clearInterval(timer); timer = null; play.textContent = "▶"; }
play.onclick = () => {
  if (timer) return stop();
  play.textContent = "❚❚";
  timer = setInterval(() => {
    slider.value = (Number(slider.value) + 1) % RUN.times.length;
    show();
  }, 1000 * RUN.seconds / RUN.times.length);
};
slider.oninput = () => { stop(); show(); };
choice.onchange = show;
show();
window.dispatchEvent(new Event("resize"));
