// Checks the shipped scenes with the Khronos glTF validator: an error or a warning fails.
// Installs the validator under build/ when it is not there; usage: node scenes/validate.mjs [FILES...]

import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { basename, dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const VERSION = "2.0.0-dev.3.10";
const here = dirname(fileURLToPath(import.meta.url));
const home = join(here, "..", "build", "gltf-validator");

if (!existsSync(join(home, "node_modules", "gltf-validator"))) {
  mkdirSync(home, { recursive: true });
  execFileSync("npm", ["install", "--silent", "--no-save", "--prefix", home,
    `gltf-validator@${VERSION}`], { stdio: "inherit" });
}
const validator = createRequire(join(home, "package.json"))("gltf-validator");

function shipped() {
  const isScene = (name) => name.endsWith(".gltf") || name.endsWith(".glb");
  const in_folder = (folder) => existsSync(folder)
    ? readdirSync(folder).filter(isScene).sort().map((name) => join(folder, name)) : [];
  return [...in_folder(here), ...in_folder(join(here, "blender")), ...in_folder(join(here, "gallery")),
    ...in_folder(join(here, "templates"))];
}

async function check(path) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {
    uri: basename(path),
    externalResourceFunction: async (uri) =>
      new Uint8Array(readFileSync(join(dirname(path), decodeURIComponent(uri)))),
  });
  const { numErrors, numWarnings, messages } = report.issues;
  console.log(`${path}: ${numErrors} errors, ${numWarnings} warnings`);
  for (const message of messages.filter((one) => one.severity < 2)) {
    console.log(`  ${message.pointer}: ${message.code}: ${message.message}`);
  }
  return numErrors + numWarnings;
}

let issues = 0;
const files = process.argv.length > 2 ? process.argv.slice(2).map((p) => resolve(p)) : shipped();
for (const path of files) {
  issues += await check(path);
}
process.exit(issues === 0 ? 0 : 1);
