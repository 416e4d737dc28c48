// Saves pictures and scenes into the folder in which the server was started, and copies command and link.
// SPDX-License-Identifier: Apache-2.0
import {numberInput, row, textRow, vectorInput} from "./controls.js";
import {button, element, newId, section} from "./dom.js";
import {nextName} from "./words.js";

/// Copies a text; where the browser does not let pages do so, shows it ready to be copied by hand.
async function copy(text, what, note) {
  try {
    await navigator.clipboard.writeText(text);
    note(`The ${what} has been copied.`);
  } catch {
    const area = element("textarea", { value: text, readOnly: true, rows: 6, "aria-label": what });
    const dialog = element(
        "dialog", {}, element("p", { textContent: `Copy the ${what} from here (Ctrl C):` }), area,
        element("form", { method: "dialog" }, element("button", { textContent: "Close" })));
    dialog.addEventListener("close", () => dialog.remove());
    document.body.append(dialog);
    dialog.showModal();
    area.select();
  }
}

/// Returns { node, update() }.
export function savePanel(session, note) {
  let name = "picture.png", sceneName = "scene.json", samples = 16, size = null;
  const file = textRow({
    label: "file",
    help: ".png or .exr, in the folder in which the server was started",
    commit: (value) => (name = value)
  });
  const sizeInput = vectorInput(
      { label: "size", names: ["width", "height"], whole: true, commit: (value) => sizeInput.update((size = value)) });
  const sizeId = newId();
  sizeInput.node.querySelector("input").id = sizeId;
  const samplesInput = numberInput({
    label: "samples",
    whole: true,
    low: 1,
    commit: (value) => samplesInput.update((samples = Math.max(1, value)))
  });
  const samplesId = newId();
  samplesInput.node.id = samplesId;
  const sceneFile = textRow(
      { label: "scene file", help: ".json, which umbrick render reads", commit: (value) => (sceneName = value) });
  const save = (message) => session.command({ type: "save", ...message });
  file.update(name);
  sceneFile.update(sceneName);
  samplesInput.update(samples);
  session.on("saved", ({ path }) => {
    const saved = path.split("/").at(-1);
    if (saved === name) file.update((name = nextName(name)));
    if (saved === sceneName) sceneFile.update((sceneName = nextName(sceneName)));
  });
  const copyOne =
      button("Copy command", () => copy(session.served.command, "command", note), "that makes this picture");
  const copyAll = button(
      "Copy command for all frames", () => copy(session.served.commandOfAll, "command", note),
      "that makes the pictures of the whole sequence, or a film with -o film.mp4");
  const saveAll = button(
      "Save scene of all frames", () => save({ what: "sequence", name: sceneName }),
      "whose volume is the whole sequence, for umbrick render with --frames");
  // The scene that makes the picture is known at rest.
  const showWhich = () => {
    saveAll.hidden = copyAll.hidden = !session.hello.sequence;
    copyOne.disabled = session.sequence?.playing ?? false;
  };
  session.on("sequence", showWhich);
  showWhich();
  return {
    node: section(
        "Save and share", false, file.node, row("size", "of the saved picture, pixels", sizeId, sizeInput.node),
        row("samples", "that are averaged", samplesId, samplesInput.node),
        element(
            "div", { className: "buttons" },
            button(
                "Save picture",
                () => save({ what: "picture", name, size: size ?? session.scene.camera.size, samples }))),
        sceneFile.node,
        element(
            "div", { className: "buttons" },
            button(
                "Save scene", () => save({ what: "scene", name: sceneName, size: session.scene.camera.size, samples })),
            saveAll),
        element(
            "div", { className: "buttons" }, copyOne, copyAll,
            button("Copy link", () => copy(location.href, "link", note), "to this page, while the server runs"))),
    update: () => sizeInput.update(size ?? session.scene.camera.size),
  };
}
