// Paths, sizes and names of files, and what a page keeps when another volume is opened.
// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";

import * as files from "../../tools/view/page/files.js";
import {Session} from "../../tools/view/page/session.js";

test("Sizes are said in the unit that fits", () => {
  assert.deepEqual(
      [0, 512, 1024, 3565158, 64 * 2 ** 20, 300 * 2 ** 30].map(files.sizeWords),
      ["0 bytes", "512 bytes", "1 KiB", "3.4 MiB", "64 MiB", "300 GiB"]);
});

test("The way to a folder begins with that of the server", () => {
  assert.deepEqual(files.crumbsOf("", "data"), [{ name: "data", path: "" }]);
  assert.deepEqual(files.crumbsOf("a/b", "data").map(({ path }) => path), ["", "a", "a/b"]);
  assert.equal(files.pathIn("", "x.vdb"), "x.vdb");
  assert.equal(files.pathIn("a/b", "x.vdb"), "a/b/x.vdb");
});

test("A sent file keeps its ending and has a name that the server takes", () => {
  assert.equal(files.uploadName("head (1).nii.gz"), "head__1_.nii.gz");
  assert.equal(files.uploadName("../../.Sch\u00e4del.nrrd"), "Scha_del.nrrd");
  const long = files.uploadName("x".repeat(300) + ".nrrd");
  assert.ok(long.length <= 100 && long.endsWith(".nrrd"));
});

test("What is too large to send is said with the way to open it", () => {
  const hello = { mostUpload: 64 * 2 ** 20, folder: "/data" };
  assert.equal(files.refusalOf({ name: "a.nrrd", size: 1000 }, hello), "");
  assert.match(files.refusalOf({ name: "a.nrrd", size: 2 ** 30 }, hello), /1 GiB.*up to 64 MiB.*\/data.*umbrick view/);
  assert.match(files.refusalOf({ name: "a.json", size: 10 }, hello), /beside it/);
  assert.match(files.refusalOf({ name: "folder", size: 0 }, hello), /empty/);
});

test("Panels of a volume that has gone hear nothing any more", () => {
  const session = new Session(() => {}, { reset: () => {} });
  const heard = [];
  session.on("x", () => heard.push("page"));
  const [built, remove] = session.collect(() => {
    session.on("x", () => heard.push("panel"));
    session.on("y", () => heard.push("y"));
    return "built";
  });
  assert.equal(built, "built");
  session.emit("x");
  remove();
  session.on("x", () => heard.push("next"));
  session.emit("x");
  session.emit("y");
  assert.deepEqual(heard, ["page", "panel", "page", "next"]);
});
