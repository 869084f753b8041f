"""Planes of the OpenEXR files that razor writes: scan lines, one part, compressed by ZIP (OpenEXR's technical
introduction and file layout)."""
import array
import struct
import sys
import zlib

LINES = 16 # of a block


def unpacked(data, size):
    if len(data) == size: # what ZIP does not make smaller is as it was
        return data
    raw = bytearray(zlib.decompress(data))
    for i in range(1, len(raw)): # bytes are differences, 128 standing for none ...
        raw[i] = raw[i - 1] + raw[i] - 128 & 255
    half = (size + 1) // 2 # ... and those at even places come first
    out = bytearray(size)
    out[0::2], out[1::2] = raw[:half], raw[half:]
    return bytes(out)


def read(path):
    """Width, height, and a dictionary from names to arrays, rows from the top: of floats, or of whole numbers where these
    are names (4294967295: none)."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError(f"{path}: no OpenEXR file")
    at, header = 8, {}
    while data[at]:
        name, at = (lambda end: (data[at:end], end + 1))(data.index(0, at))
        _, at = (lambda end: (data[at:end], end + 1))(data.index(0, at))
        size = struct.unpack_from("<i", data, at)[0]
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    if header[b"compression"] != b"\x03":
        raise ValueError(f"{path}: not compressed by ZIP")
    names, types, c, channels = [], [], 0, header[b"channels"]
    while channels[c]:
        end = channels.index(0, c)
        kind = struct.unpack_from("<i", channels, end + 1)[0]
        if kind not in (0, 2):
            raise ValueError(f"{path}: a channel is neither of floats nor of whole numbers")
        types.append("I" if kind == 0 else "f")
        names.append(channels[c:end].decode())
        c = end + 17
    x0, y0, x1, y1 = struct.unpack("<4i", header[b"dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    planes = {name: array.array(kind) for name, kind in zip(names, types)}
    blocks = (height + LINES - 1) // LINES
    for offset in struct.unpack_from(f"<{blocks}Q", data, at + 1):
        y, size = struct.unpack_from("<2i", data, offset)
        lines = min(LINES, y1 + 1 - y)
        values = array.array("I", unpacked(data[offset + 8:offset + 8 + size], lines * width * len(names) * 4))
        if sys.byteorder == "big":
            values.byteswap()
        for line in range(lines):
            for n, name in enumerate(names):
                begin = (line * len(names) + n) * width
                planes[name].frombytes(values[begin:begin + width].tobytes())
    return width, height, planes
