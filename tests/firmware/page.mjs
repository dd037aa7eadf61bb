// node page.mjs MODULE: runs the hash scenes in WebAssembly, and ends with what they end with.
import { readFileSync } from "node:fs";

class Exit {
  constructor(code) {
    this.code = code;
  }
}

const decoder = new TextDecoder();
const host = {
  print: (text, length) => process.stdout.write(decoder.decode(new Uint8Array(memory.buffer, text, length))),
  exit: (code) => {
    throw new Exit(code);
  },
};
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), { host });
const { memory, main } = instance.exports;
try {
  main();
} catch (end) {
  if (!(end instanceof Exit)) throw end;
  process.exitCode = end.code;
}
