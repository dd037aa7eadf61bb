// The entry for Node, which has no fetch for files: loads the module at once. `await init()` stays allowed, so that
// the same program runs here and in a browser.
import { readFileSync } from "node:fs";
import { initSync } from "./pointmass.js";

const module = readFileSync(new URL("./pointmass_bg.wasm", import.meta.url));
const exports = initSync({ module });

export * from "./pointmass.js";
export default async function init() {
  return exports;
}
