"use strict";
// Loads a vessel's program, which is WebAssembly, with its numbers from the text of a page. Nothing is fetched.
const MATH = ["acos", "asin", "atan", "atan2", "cos", "cosh", "exp", "hypot", "log", "pow", "sin", "sinh", "tan", "tanh"];

// The bytes that `PackedNumbers` wrote as text
async function unpackNumbers(text) {
  const packed = Uint8Array.from(atob(text.trim()), character => character.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

// The program at a place [offset, size] of these bytes
const compileProgram = (buffer, place) => WebAssembly.compile(new Uint8Array(buffer, ...place));

// Functions and memory of one instance of a program
async function startProgram(program) {
  const math = Object.fromEntries(MATH.map(name => [name, Math[name]]));
  math.fmod = (x, y) => x % y;
  return (await WebAssembly.instantiate(program, { math })).exports;
}

// Copy an array of floats into the memory of an instance; returns its address.
function putNumbers(exports, array) {
  const at = exports.allocate(array.byteLength);
  new Float64Array(exports.memory.buffer, at, array.length).set(array);
  return at;
}
