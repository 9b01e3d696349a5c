"""The two chunks of a .glb file."""
import json
import struct
from pathlib import Path


def read_glb(path):
    """JSON and binary chunk."""
    data = Path(path).read_bytes()
    length, = struct.unpack_from('<I', data, 12)
    return json.loads(data[20:20 + length]), data[28 + length:]


def pack_glb(gltf, binary):
    """The bytes of a file of both; the binary chunk is of whole words."""
    text = json.dumps(gltf).encode()
    text += b' ' * (-len(text) % 4)
    chunks = struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(binary), b'BIN\0') + binary
    return struct.pack('<4sII', b'glTF', 2, 12 + len(chunks)) + chunks
