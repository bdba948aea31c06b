// SPDX-License-Identifier: Apache-2.0
// The records of a zip file as they stand (PKWARE's APPNOTE, 4.3): where each payload begins, and its flags.

export function entriesOf(bytes) {
  const end = bytes.lastIndexOf(Buffer.from('PK\x05\x06', 'latin1'));
  if (end < 0) throw new Error('no end of central directory');
  const count = bytes.readUInt16LE(end + 10);
  let at = bytes.readUInt32LE(end + 16);
  const entries = [];
  for (let index = 0; index < count; index += 1) {
    if (bytes.readUInt32LE(at) !== 0x02014b50) throw new Error(`record ${index} of the central directory is none`);
    const local = bytes.readUInt32LE(at + 42);
    const [nameLength, extraLength, commentLength] = [28, 30, 32].map((field) => bytes.readUInt16LE(at + field));
    const localExtra = bytes.readUInt16LE(local + 28);
    const payload = local + 30 + bytes.readUInt16LE(local + 26) + localExtra;
    const size = bytes.readUInt32LE(at + 20);
    entries.push({
      name: bytes.subarray(at + 46, at + 46 + nameLength).toString(), madeBy: bytes.readUInt16LE(at + 4), needed: bytes.readUInt16LE(at + 6),
      flags: bytes.readUInt16LE(at + 8), method: bytes.readUInt16LE(at + 10), external: bytes.readUInt32LE(at + 38),
      extra: extraLength, localExtra, comment: commentLength, payload, size, bytes: bytes.subarray(payload, payload + size),
    });
    at += 46 + nameLength + extraLength + commentLength;
  }
  return entries;
}
