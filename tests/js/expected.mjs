// Compares what payload.mjs computed with the package's version and with tests/hashes.txt.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const read = (path) => readFileSync(new URL(path, import.meta.url), "utf8");

// name -> hash, as in tests/hashes.txt: lines `name hash`, comments after `#`.
export const hashes = Object.fromEntries(
  read("../hashes.txt")
    .split("\n")
    .map((line) => line.replace(/#.*/, "").trim())
    .filter(Boolean)
    .map((line) => line.split(/\s+/)),
);

export function check(result) {
  assert.equal(result.version, JSON.parse(read("../../target/npm/package.json")).version);
  // PLACEHOLDER: when payload.mjs computes the hashes: assert.deepEqual(result.hashes, hashes);
}
