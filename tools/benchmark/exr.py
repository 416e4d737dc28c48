"""Reads the EXR files that umbrick writes (scan lines; no, ZIPS or ZIP compression), since Debian 12 has no Python
module for it."""
# SPDX-License-Identifier: Apache-2.0
import struct
import zlib

import numpy as np

LINES_PER_CHUNK = {0: 1, 2: 1, 3: 16}
PIXEL_TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _unpack(chunk, size):
    if len(chunk) == size:  # stored as it is when compression does not help
        return chunk
    delta = np.frombuffer(zlib.decompress(chunk), np.uint8).astype(np.int64)
    delta[1:] -= 128
    halves = np.cumsum(delta).astype(np.uint8)  # modulo 256
    result = np.empty_like(halves)
    middle = (len(halves) + 1) // 2
    result[0::2], result[1::2] = halves[:middle], halves[middle:]
    return result.tobytes()


def read_rgba(path):
    """height x width x RGBA, row 0 at the bottom; a missing alpha is 1."""
    return read_channels(path, "RGBA")


def read_channels(path, names):
    """height x width x the channels of these names, row 0 at the bottom; one that is missing is 1."""
    with open(path, "rb") as file:
        data = file.read()
    magic, version = struct.unpack_from("<II", data)
    if magic != 20000630 or version & 0x1a00:
        raise SystemExit(f"{path}: not an EXR file of scan lines in one part")
    at, header = 8, {}
    while data[at]:
        name, at = _text(data, at)
        _, at = _text(data, at)
        size, = struct.unpack_from("<i", data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    channels, c = [], 0
    while header["channels"][c]:
        name, c = _text(header["channels"], c)
        channels.append((name, PIXEL_TYPES[struct.unpack_from("<i", header["channels"], c)[0]]))
        c += 16
    compression = header["compression"][0]
    if compression not in LINES_PER_CHUNK:
        raise SystemExit(f"{path}: compression {compression} is not none, ZIPS or ZIP")
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    lines = LINES_PER_CHUNK[compression]
    offsets = struct.unpack_from(f"<{-(-height // lines)}Q", data, at + 1)
    planes = {name: np.ones((height, width)) for name in names}
    line_bytes = sum(kind.itemsize for _, kind in channels) * width
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        y -= y0
        count = min(lines, height - y)
        block = _unpack(data[offset + 8:offset + 8 + size], count * line_bytes)
        p = 0
        for line in range(y, y + count):
            for name, kind in channels:
                if name in planes:
                    planes[name][line] = np.frombuffer(block, kind, width, p)
                p += kind.itemsize * width
    return np.stack([planes[name] for name in names], 2)[::-1]
