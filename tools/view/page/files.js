// Files that the page opens: paths below the folder of the server, sizes in words, and what may be sent.
// SPDX-License-Identifier: Apache-2.0

/// Returns a size in words: "512 bytes", "3.4 MiB".
export function sizeWords(bytes) {
  const units = ["bytes", "KiB", "MiB", "GiB", "TiB"];
  const power = bytes < 1024 ? 0 : Math.min(units.length - 1, Math.floor(Math.log2(bytes) / 10));
  const size = bytes / 1024 ** power;
  return `${power === 0 || size >= 100 ? Math.round(size) : Number(size.toPrecision(2))} ${units[power]}`;
}

/// Returns the path of something in a folder.
export const pathIn = (folder, name) => (folder ? `${folder}/${name}` : name);

/// Returns the folders on the way to a path: [{ name, path }], beginning with that of the server.
export function crumbsOf(path, top) {
  const names = path ? path.split("/") : [];
  return [{ name: top, path: "" }, ...names.map((name, i) => ({ name, path: names.slice(0, i + 1).join("/") }))];
}

/// Returns the name under which a file is sent: the server takes letters, digits, -, _ and . alone, and needs the ending.
export function uploadName(name) {
  const plain = name.normalize("NFKD").replace(/[^A-Za-z0-9._-]/g, "_").replace(/^[._-]+/, "");
  return plain.length > 100 ? plain.slice(plain.length - 100).replace(/^[._-]+/, "") : plain;
}

/// Returns why a file cannot be sent, or nothing. @param hello  of the server
export function refusalOf({ name, size }, { mostUpload, folder }) {
  if (name.toLowerCase().endsWith(".json"))
    return `${name}: a scene is opened from ${folder}, where its volume lies beside it; a transfer function by Load`;
  if (size === 0) return `${name} is empty, or a folder`;
  if (size > mostUpload)
    return `${name} has ${sizeWords(size)}, and a page sends up to ${sizeWords(mostUpload)}: put it into ${folder} ` +
        "and choose Open, or start umbrick view with its path";
  return "";
}
