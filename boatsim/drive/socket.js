"use strict";
// The socket to boatsim, which simulates the boat: sticks go there, states come back.
let socket, lost = false, sent = 0;

function connect() {
  socket = new WebSocket(location.href.replace(/^http/, "ws") + "socket");
  socket.onopen = () => { lost = false; opened = performance.now(); word(); };
  socket.onmessage = e => {
    const said = JSON.parse(e.data);
    if (said.hello) begin(said.hello);
    if (said.frame) take(said.frame);
    if (said.over) {
      over = said.over.wrong ? `The run has ended: ${said.over.wrong}` : `Saved to ${said.over.folder}. You may close this page.`;
      word();
    }
  };
  socket.onclose = e => {
    $("end").disabled = true;
    lost = true;
    if (e.code === 4001) over = "Another page drives this boat already.";
    word();
    if (!over) setTimeout(connect, 1000);
  };
}
document.addEventListener("visibilitychange", () => {
  if (document.hidden && socket.readyState === 1) socket.send('{"hidden": true}');
});
$("end").onclick = () => { socket.send('{"end": true}'); over = "Saving …"; $("end").disabled = true; word(); };

function handOver(changed, now) {
  if (!socket || socket.readyState !== 1 || !changed && now - sent < 80) return false;
  sent = now;
  socket.send(JSON.stringify({ sticks, moved }));
  return true;
}

const trouble = () => lost ? "No connection: the run has ended, or boatsim has." : hello ? "" : "Connecting to boatsim …";

function showTiming() {
  $("late").textContent = frame.late;
  $("late").classList.toggle("bad", frame.late > 0);
  $("worst").textContent = `${frame.worst.toFixed(0)} ms`;
  $("latency").textContent = frame.latency === null ? "–" : `${frame.latency.toFixed(0)} ms`;
}

start();
connect();
