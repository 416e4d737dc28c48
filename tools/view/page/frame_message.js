// A picture as the server sends it: four bytes with the length of a JSON text, the text, and the encoded picture.
// SPDX-License-Identifier: Apache-2.0

/// @return { header, bytes }
/// @throw Error  the message is shorter than it says, or its text is no JSON
export function parseFrame(buffer) {
  if (buffer.byteLength < 4) throw new Error("a picture's message is too short");
  const length = new DataView(buffer).getUint32(0, true);
  if (4 + length > buffer.byteLength) throw new Error("a picture's message is shorter than it says");
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  return { header, bytes: new Uint8Array(buffer, 4 + length) };
}
