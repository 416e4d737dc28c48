// Numbers and states in words.
// SPDX-License-Identifier: Apache-2.0

/// Returns a number with few digits: 1234.5, 0.0041, 3.2e-7.
export function shortNumber(value, digits = 5) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "-";
  return String(Number(value.toPrecision(digits)));
}

const errorWords = (error) => (error === null || error === undefined ? "" : `, error ${shortNumber(error, 2)}`);

/// Says how good the present picture is: "draft", "8 samples, error 0.006", "done: error 0.004".
export function statusWords(status) {
  const { samples, error, draft, done, paused, text } = status;
  const count = `${samples} ${samples === 1 ? "sample" : "samples"}`;
  if (text) return text;
  if (paused) return `paused: ${count}${errorWords(error)}`;
  if (draft) return "draft";
  if (done) return error === null || error === undefined ? `done: ${count}` : `done: error ${shortNumber(error, 2)}`;
  return count + errorWords(error);
}

/// Says what lies under the pointer.
export function probeWords(probe, unit) {
  if (probe.value === null || probe.value === undefined) return "nothing here";
  const place = probe.world ? ` at (${probe.world.map((x) => shortNumber(x, 4)).join(", ")})` : "";
  const depth = probe.depth === null || probe.depth === undefined ? "" : `, depth ${shortNumber(probe.depth, 4)}`;
  return `value ${shortNumber(probe.value, 4)}${unit ? " " + unit : ""}${place}${depth}`;
}

/// Keeps the errors of the present picture over time. A picture begins anew where its time or samples fall.
export function withErrorPoint(history, {ms, error, standardError, samples, draft}) {
  const last = history.at(-1);
  const begins = draft || (last && (ms < last.ms || samples < last.samples));
  const kept = begins ? [] : history;
  if (draft || error === null || error === undefined || !(error > 0)) return kept;
  if (kept.at(-1)?.samples === samples) return kept;
  return [...kept, { ms, error, standardError, samples }].slice(-2000);
}

/// Says what the chart shows: "done: error 0.004 after 2.3 s, 16 samples".
export function chartWords(history, status) {
  const last = history.at(-1);
  if (!last) return "No error is known yet";
  const begin = status?.done ? "done: error" : "error";
  const target = status?.targetError > 0 && last.error > status.targetError ? `, target ${shortNumber(status.targetError, 2)}` : "";
  return `${begin} ${shortNumber(last.error, 2)} after ${shortNumber(last.ms / 1000, 2)} s, ${last.samples} samples${target}`;
}

/// Returns the name to propose after a file was saved, since the server replaces none: a.png, a-2.png, a-3.png.
export function nextName(name) {
  const [, stem, number, ending] = name.match(/^(.*?)(?:-(\d+))?(\.[^.]*)?$/);
  return `${stem}-${number ? Number(number) + 1 : 2}${ending ?? ""}`;
}
