// Opens another volume or scene: from the folder in which the server was started, or by dropping a small file.
// SPDX-License-Identifier: Apache-2.0
import {button, element} from "./dom.js";
import {crumbsOf, pathIn, refusalOf, sizeWords, uploadName} from "./files.js";

const kKinds = { folder: "folder", volume: "volume", scene: "scene" };

function entryRow(entry, act) {
  const size = entry.kind === "folder" ? "" : sizeWords(entry.bytes);
  const name = button(entry.name + (entry.kind === "folder" ? "/" : ""), act);
  name.className = "link";
  return element(
      "tr", { className: entry.kind }, element("td", {}, name), element("td", { textContent: kKinds[entry.kind] }),
      element("td", { className: "size", textContent: size }));
}

function listNodes(listing, session, choose) {
  const { path, entries, dicomFiles, left, links } = listing;
  const top = session.hello.folder.split("/").at(-1) || "/";
  const crumbs = element("nav", { className: "crumbs", "aria-label": "folders" });
  const list = crumbsOf(path, top);
  list.forEach((crumb, i) => {
    const last = i === list.length - 1;
    const part = last ? element("strong", { textContent: crumb.name }) :
                        button(crumb.name, () => session.files(crumb.path));
    if (!last) part.className = "link";
    crumbs.append(part, last ? "" : " / ");
  });
  const table = element("tbody", {});
  for (const entry of entries) {
    const whole = pathIn(path, entry.name);
    table.append(entryRow(entry, () => (entry.kind === "folder" ? session.files(whole) : choose(whole))));
  }
  const notes = [];
  if (entries.length === 0) notes.push("There is nothing here that a page can open.");
  if (left > 0) notes.push(`${left} more are not listed.`);
  if (links > 0) notes.push(`${links} links are not followed.`);
  const whole = button(`Open the ${dicomFiles} DICOM files of this folder as one volume`, () => choose(path));
  return [
    crumbs, ...(dicomFiles > 1 ? [element("div", { className: "buttons" }, whole)] : []),
    element("div", { className: "scrolled" }, element("table", { className: "files" }, table)),
    ...notes.map((textContent) => element("p", { className: "quiet", textContent }))
  ];
}

/// Sends a file to the server, which opens it. Returns when it has arrived, or was refused.
async function send(file, session, problem) {
  const refusal = refusalOf(file, session.hello);
  if (refusal) return problem(refusal);
  try {
    const address = new URL(`upload/${uploadName(file.name)}`, location.href);
    const answer = await fetch(address, { method: "POST", body: file });
    if (!answer.ok) problem(`${file.name}: ${await answer.text()}`);
  } catch (error) {
    problem(`${file.name} could not be sent: ${error.message}`);
  }
}

// A file that is dragged over the page may be dropped anywhere.
function takeDrops(session, problem) {
  const veil = element(
      "div", { className: "veil", hidden: true },
      element("p", {}, "Drop a volume to look at it"), element("p", { className: "quiet" }));
  const hasFile = (event) => [...(event.dataTransfer?.types ?? [])].includes("Files");
  addEventListener("dragover", (event) => {
    if (!hasFile(event) || !session.hello?.folder) return;
    event.preventDefault();
    veil.lastChild.textContent = `up to ${sizeWords(session.hello.mostUpload)}; larger ones are opened by their path`;
    veil.hidden = false;
  });
  addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) veil.hidden = true;
  });
  addEventListener("drop", (event) => {
    veil.hidden = true;
    if (!hasFile(event) || !session.hello?.folder) return;
    event.preventDefault();
    const [file, ...others] = event.dataTransfer.files;
    if (others.length > 0) return problem("One file at a time: a volume of several files is opened by its path.");
    if (file) send(file, session, problem);
  });
  return veil;
}

/// @return { nodes, show() }; the nodes are for the end of the page
export function filesDialog(session, notices) {
  const problem = (text) => notices.error(text);
  const content = element("div", {});
  const file = element("input", { type: "file", hidden: true });
  const about = element("p", { className: "quiet" });
  const dialog = element(
      "dialog", { className: "open-file", "aria-label": "Open a volume or a scene" },
      element(
          "form", { method: "dialog" }, element("strong", { textContent: "Open a volume or a scene" }),
          element("button", { textContent: "Close" })),
      content,
      element(
          "div", { className: "buttons" },
          button("From this computer ...", () => file.click(), "sends a small file to the server")),
      about, file);
  const choose = (path) => {
    dialog.close();
    session.command({ type: "open", path });
  };
  file.addEventListener("change", () => {
    const [chosen] = file.files;
    file.value = "";
    if (!chosen) return;
    dialog.close();
    send(chosen, session, problem);
  });
  session.on("files", (listing) => content.replaceChildren(...listNodes(listing, session, choose)));
  const bar = element("progress", { max: 1, value: 0 }), words = element("span", {});
  const opening = element("div", { className: "opening", role: "status", hidden: true }, words, bar);
  session.on("opening", ({ state, name, share, text }) => {
    opening.hidden = state !== "running";
    words.textContent = `Opening ${name}`;
    bar.value = share ?? 0;
    if (state === "none") problem(text);
    if (state === "done") notices.note(text || `${name} is open`);
  });
  return {
    nodes: [dialog, takeDrops(session, problem), opening],
    show: () => {
      about.textContent = `Files of up to ${sizeWords(session.hello.mostUpload)} may be sent, also by dropping them ` +
          "on the page. Larger ones are opened from the folder, or by umbrick view and their path.";
      content.replaceChildren();
      session.files("");
      dialog.showModal();
    },
  };
}
