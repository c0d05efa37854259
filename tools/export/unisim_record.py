#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prediction files of libunisim (format: drivers/recorded/README.md): writing and checking.

Predictions of any network, made on a workstation, become a file that a robot or a laptop runs:

    from unisim_record import RecordWriter

    with RecordWriter("office.usr", sequence="office", predictor="my-network",
                      image_size=(640, 480)) as record:
        for k, frame in enumerate(range(0, 500, 5)):         # every fifth frame is a keyframe
            record.keyframe(k, frame, timestamp_ns=times[frame])
        for i in range(99):
            T, depth_i, depth_j, conf_i, conf_j = network.pair(images[i], images[i + 1])
            record.pair(i, i + 1, T, depth_i, depth_j, conf_i, conf_j)
        for ids in windows:                                  # as the session asks: 16, overlap 2
            poses, depths, confidences = network.window([images[k] for k in ids])
            record.window(ids, poses, depths, confidences)

    unisim-replay SEQUENCE --stride 5 --predictor recorded --predictions office.usr --out out/office

Poses are 4x4 (or 3x4) camera-to-world matrices with OpenCV axes, `pair` wants T_i_j: points of
camera j to camera i. Depth is z-depth in the unit of the poses beside it, zero or NaN where there
is none. Numbers that are not finite elsewhere are refused at once.

    python3 unisim_record.py info FILE       prints what a file holds and checks every byte of it
"""

import argparse
import struct
import sys

try:
    import numpy as np
except ImportError as missing:
    if __name__ != "__main__":
        raise
    print(f"unisim_record.py: Python package numpy is missing ({missing}): pip install -r "
          "requirements.txt", file=sys.stderr)
    sys.exit(2)

MAGIC = b"\x89USR\r\n\x1a\n"
VERSION = 1
MAX_VIEWS = 64
UNKNOWN_TIME = -(2**63)
OK, PENDING, REJECTED = 0, 1, 2
FRAME, KEYFRAME, PAIR, WINDOW, REVISION, FRAME_POSE, INFO, END = range(1, 9)
KIND_NAMES = {FRAME: "frames", KEYFRAME: "keyframes", PAIR: "pairs", WINDOW: "windows",
              REVISION: "revisions", FRAME_POSE: "frame poses", INFO: "info", END: "end"}


class RecordError(Exception):
    """The file or a prediction is not what the format allows; the text says where and why."""


def _crc_tables():
    """Remainders for slicing: tables[k][b] is byte b followed by k zero bytes."""
    table = np.arange(256, dtype=np.uint32)
    for _ in range(8):
        table = np.where(table & 1, (table >> 1) ^ np.uint32(0x82F63B78), table >> 1)
    return table.astype(np.uint32)


_TABLE = _crc_tables()


def _advance_matrix(byte_count):
    """Images of the 32 bits of a CRC state after `byte_count` zero bytes (GF(2) matrix)."""
    step = np.array([1 << k for k in range(32)], dtype=np.uint32)
    step = (step >> 8) ^ _TABLE[step & 0xFF]
    result = np.array([1 << k for k in range(32)], dtype=np.uint32)
    while byte_count:
        if byte_count & 1:
            result = _apply(step, result)
        step = _apply(step, step)
        byte_count >>= 1
    return result


def _apply(matrix, states):
    out = np.zeros_like(states)
    for k in range(32):
        out ^= np.where((states >> np.uint32(k)) & np.uint32(1), matrix[k], np.uint32(0))
    return out


def crc32c(data, crc=0):
    """CRC-32C of bytes. Large inputs are cut into lanes that numpy works through side by side."""
    state = (crc ^ 0xFFFFFFFF) & 0xFFFFFFFF
    data = np.frombuffer(data, dtype=np.uint8)
    lanes = 1024
    if data.size >= 16 * lanes:
        length = data.size // lanes
        block = data[:lanes * length].reshape(lanes, length)
        states = np.zeros(lanes, dtype=np.uint32)
        states[0] = state
        for column in np.ascontiguousarray(block.T):
            states = (states >> np.uint32(8)) ^ _TABLE[(states ^ column) & np.uint32(0xFF)]
        data = data[lanes * length:]
        while states.size > 1:  # neighbours become one lane of twice the length
            states = _apply(_advance_matrix(length), states[0::2]) ^ states[1::2]
            length *= 2
        state = int(states[0])
    table = _TABLE.tolist()
    for byte in data.tolist():
        state = (state >> 8) ^ table[(state ^ byte) & 0xFF]
    return state ^ 0xFFFFFFFF


def _pad(data):
    return data + bytes(-len(data) % 8)


def _moment(at_keyframe):
    return struct.pack("<qii", -1, at_keyframe, 0)


def _pose_bytes(matrix, what):
    """A rigid 4x4 or 3x4 matrix as quaternion x y z w, translation, scale 1."""
    matrix = np.asarray(matrix, dtype=np.float64)
    if matrix.shape not in ((4, 4), (3, 4)):
        raise RecordError(f"{what}: pose has shape {matrix.shape}, expected (4, 4) or (3, 4)")
    if not np.isfinite(matrix).all():
        raise RecordError(f"{what}: pose is not finite")
    u, _, vt = np.linalg.svd(matrix[:3, :3])
    rotation = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
    if np.abs(rotation - matrix[:3, :3]).max() > 1e-2:
        raise RecordError(f"{what}: pose is not a rotation with a translation "
                          "(scale goes into the depths and translations)")
    return struct.pack("<8d", *_quaternion(rotation), *matrix[:3, 3], 1.0)


def _quaternion(rotation):
    """Unit quaternion x y z w through its largest component; of the two the one with w >= 0."""
    r = rotation
    trace = np.trace(r)
    squares = np.array([1 + 2 * r[0, 0] - trace, 1 + 2 * r[1, 1] - trace,
                        1 + 2 * r[2, 2] - trace, 1 + trace])
    k = int(np.argmax(squares))
    products = np.array([
        [squares[0], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0], r[2, 1] - r[1, 2]],
        [r[0, 1] + r[1, 0], squares[1], r[1, 2] + r[2, 1], r[0, 2] - r[2, 0]],
        [r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], squares[2], r[1, 0] - r[0, 1]],
        [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], squares[3]]])
    quaternion = products[k]
    return np.copysign(1.0, quaternion[3]) * quaternion / np.linalg.norm(quaternion)


def _depth_bytes(depth, confidence, what):
    depth = np.ascontiguousarray(depth, dtype="<f4")
    if depth.ndim != 2 or 0 in depth.shape:
        raise RecordError(f"{what}: depth has shape {depth.shape}, expected (height, width)")
    parts = [struct.pack("<4i", depth.shape[1], depth.shape[0], confidence is not None, 0),
             depth.tobytes()]
    if confidence is not None:
        confidence = np.ascontiguousarray(confidence, dtype="<f4")
        if confidence.shape != depth.shape:
            raise RecordError(f"{what}: confidence has shape {confidence.shape}, "
                              f"depth {depth.shape}")
        if not np.isfinite(confidence).all():
            raise RecordError(f"{what}: confidence is not finite")
        parts.append(confidence.tobytes())
    return _pad(b"".join(parts))


def _check_numbers(what, **numbers):
    for name, value in numbers.items():
        if not np.isfinite(value) or value < 0:
            raise RecordError(f"{what}: {name} is {value}, expected a number >= 0 (0: not known)")


class RecordWriter:
    """Writes one prediction file; a context manager. Records are in the file when a call returns.

    `image_size` is (width, height) in pixels of the images the focal lengths are about.
    Predictions are given out as soon as a run has the keyframe `at_keyframe` (default: the last
    one they are about)."""

    def __init__(self, path, sequence="", predictor="python", image_size=(0, 0),
                 creator="unisim_record.py"):
        self._records = 0
        self._keyframes = 0
        self._last_frame = -1
        self._file = open(path, "wb")
        width, height = image_size
        header = struct.pack("<iiiI", int(width), int(height), -1, 0)
        for text in (creator, sequence, predictor):
            encoded = text.encode("utf-8", "replace")[:4096]
            header += struct.pack("<I", len(encoded)) + encoded
        header += bytes((4 - len(header)) % 8)
        head = MAGIC + struct.pack("<II", VERSION, 16 + len(header) + 4) + header
        self._file.write(head + struct.pack("<I", crc32c(head)))

    def __enter__(self):
        return self

    def __exit__(self, kind, value, traceback):
        if kind is None:
            self.close()
        else:
            self._file.close()  # without its end the file says that it is not complete

    def _append(self, kind, key, data=b""):
        key = _pad(key)
        data = _pad(data)
        head = struct.pack("<IIQI", kind, len(key), len(data), crc32c(data))
        self._file.write(head + struct.pack("<I", crc32c(key, crc32c(head))) + key + data)
        self._file.flush()
        self._records += 1

    def keyframe(self, keyframe_id, frame_index, timestamp_ns=UNKNOWN_TIME):
        """Frame `frame_index` of the sequence is keyframe `keyframe_id` (0, 1, 2 ...)."""
        if keyframe_id != self._keyframes or frame_index <= self._last_frame:
            raise RecordError(f"keyframe {keyframe_id} (frame {frame_index}): ids are 0, 1, 2 ... "
                              f"and frames ascend; expected id {self._keyframes} and a frame "
                              f"after {self._last_frame}")
        self._append(KEYFRAME, struct.pack("<qqii", frame_index, timestamp_ns, keyframe_id, 0))
        self._keyframes += 1
        self._last_frame = frame_index

    def pair(self, i, j, T_i_j, depth_i, depth_j, confidence_i=None, confidence_j=None,
             focal_px=0.0, center_sigma=0.0, at_keyframe=None):
        """Two-view prediction of keyframes i and j = i + 1."""
        what = f"pair {i},{j}"
        _check_numbers(what, focal_px=focal_px, center_sigma=center_sigma)
        at_keyframe = j if at_keyframe is None else at_keyframe
        data = struct.pack("<2d", focal_px, center_sigma) + _pose_bytes(T_i_j, what)
        data += _depth_bytes(depth_i, confidence_i, what)
        data += _depth_bytes(depth_j, confidence_j, what)
        self._append(PAIR, _moment(at_keyframe) + struct.pack("<4i", OK, i, j, 0), data)

    def reject_pair(self, i, j, reason, at_keyframe=None):
        """The pair cannot be predicted; `reason` is one line."""
        at_keyframe = j if at_keyframe is None else at_keyframe
        key = _moment(at_keyframe) + struct.pack("<4i", REJECTED, i, j, 0)
        self._append(PAIR, key, reason.encode("utf-8"))

    def window(self, ids, T_window_kf, depths, confidences=None, focal_px=0.0, center_sigma=0.0,
               token=None, solved_ids=None, at_keyframe=None, unit=None):
        """Multi-view prediction of the keyframes `ids`, as the session asks for them.

        One pose, depth and confidence per id, or per `solved_ids` where some views were lost.
        `unit`, of a network that knows metres: metres in a unit of the poses, the relative standard
        deviation of this window, and that of what all windows share."""
        what = f"window {ids[0]}..{ids[-1]}"
        solved = list(ids) if solved_ids is None else list(solved_ids)
        confidences = [None] * len(solved) if confidences is None else confidences
        if not 2 <= len(ids) <= MAX_VIEWS or not 2 <= len(solved) <= len(ids):
            raise RecordError(f"{what}: {len(solved)} of {len(ids)} views, expected 2 to 64")
        if not len(T_window_kf) == len(depths) == len(confidences) == len(solved):
            raise RecordError(f"{what}: poses, depths and confidences must be {len(solved)} each")
        if any(b <= a for a, b in zip(ids, ids[1:])) or not set(solved) <= set(ids):
            raise RecordError(f"{what}: ids must ascend and contain those that were solved")
        _check_numbers(what, focal_px=focal_px, center_sigma=center_sigma)
        at_keyframe = ids[-1] if at_keyframe is None else at_keyframe
        token = self._records if token is None else token
        key = _moment(at_keyframe) + struct.pack(f"<ii{len(ids)}i", OK, len(ids), *ids)
        data = struct.pack("<2dqii", focal_px, center_sigma, token, len(solved), 0)
        data += _pad(struct.pack(f"<{len(solved)}i", *solved))
        data += b"".join(_pose_bytes(pose, what) for pose in T_window_kf)
        data += b"".join(_depth_bytes(d, c, what) for d, c in zip(depths, confidences))
        if unit is not None:
            metres, sigma, common_sigma = unit
            _check_numbers(what, metres=metres, sigma=sigma, common_sigma=common_sigma)
            data += struct.pack("<3d", metres, sigma, common_sigma)
        self._append(WINDOW, key, data)

    def reject_window(self, ids, reason, at_keyframe=None):
        """The window cannot be predicted; `reason` is one line."""
        at_keyframe = ids[-1] if at_keyframe is None else at_keyframe
        key = _moment(at_keyframe) + struct.pack(f"<ii{len(ids)}i", REJECTED, len(ids), *ids)
        self._append(WINDOW, key, reason.encode("utf-8"))

    def close(self, focal_px=0.0):
        """Marks the file as complete. `focal_px`: the last estimate, 0 if there is none."""
        if self._file.closed:
            return
        self._append(INFO, struct.pack("<3dq4i", focal_px, 0.0, 0.0, 0, 1, 0, 0, 0))
        self._append(END, struct.pack("<q", self._records))
        self._file.close()


def read_header(file):
    """Texts, image size and keyframe count of an open file; leaves it at the first record."""
    head = file.read(16)
    if head[:8] != MAGIC:
        raise RecordError("byte 0: not a prediction file")
    if len(head) < 16:
        raise RecordError("cut off inside the header")
    version, size = struct.unpack("<II", head[8:16])
    if version != VERSION:
        raise RecordError(f"byte 8: format version {version}, this script reads {VERSION}")
    if not 48 <= size <= 65536 or size % 8:
        raise RecordError(f"byte 12: header length {size} is impossible")
    rest = file.read(size - 16)
    if len(rest) < size - 16:
        raise RecordError("cut off inside the header")
    if crc32c(head + rest[:-4]) != struct.unpack("<I", rest[-4:])[0]:
        raise RecordError("byte 0: checksum of the header is wrong")
    width, height, keyframes, _ = struct.unpack("<iiiI", rest[:16])
    texts = []
    at = 16
    for _ in range(3):
        length, = struct.unpack("<I", rest[at:at + 4])
        texts.append(rest[at + 4:at + 4 + length].decode("utf-8", "replace"))
        at += 4 + length
    return {"version": version, "creator": texts[0], "sequence": texts[1], "predictor": texts[2],
            "image_size": (width, height), "keyframe_count": keyframes}


def read_records(file):
    """Yields (offset, kind, key, data) of every whole record; raises RecordError on damage."""
    while True:
        offset = file.tell()
        head = file.read(24)
        if len(head) < 24:
            return
        kind, key_bytes, data_bytes, data_crc, head_crc = struct.unpack("<IIQII", head)
        if key_bytes > 4096 or key_bytes % 8 or data_bytes % 8:
            raise RecordError(f"byte {offset}: checksum of a record is wrong")
        key = file.read(key_bytes)
        if len(key) < key_bytes:
            return
        if crc32c(key, crc32c(head[:20])) != head_crc:
            raise RecordError(f"byte {offset}: checksum of a record is wrong")
        data = file.read(data_bytes)
        if len(data) < data_bytes:
            return
        if crc32c(data) != data_crc:
            raise RecordError(f"byte {offset}: checksum of the record's data is wrong")
        yield offset, kind, key, data


def info(path, out=sys.stdout):
    """Prints what the file holds and checks every byte. Returns True when it is complete."""
    with open(path, "rb") as file:
        header = read_header(file)
        counts = {}
        rejected = {PAIR: 0, WINDOW: 0}
        records, whole, complete = 0, file.tell(), False
        for offset, kind, key, _ in read_records(file):
            if kind in rejected and struct.unpack("<i", key[16:20])[0] == REJECTED:
                rejected[kind] += 1
            if kind == END:
                complete = struct.unpack("<q", key[:8])[0] == records
                if not complete:
                    raise RecordError(f"byte {offset}: records are missing")
            counts[kind] = counts.get(kind, 0) + 1
            records += 1
            whole = file.tell()
        size = file.seek(0, 2)
    width, height = header["image_size"]
    print(f"{path}: format {header['version']}, {size} bytes, written by {header['creator']}",
          file=out)
    print(f"sequence {header['sequence'] or 'not named'}, predictor {header['predictor']}, images "
          + (f"{width}x{height}" if width else "of unknown size"), file=out)
    for kind in sorted(counts):
        if kind in (INFO, END):
            continue
        name = KIND_NAMES.get(kind, f"records of unknown kind {kind}")
        note = f" ({rejected[kind]} rejected)" if rejected.get(kind) else ""
        print(f"{name}: {counts[kind]}{note}", file=out)
    print("complete, every checksum is right" if complete else
          f"cut off after byte {whole}: {size - whole} bytes are no whole record; what comes before "
          "is good", file=out)
    return complete


def main(arguments=None):
    parser = argparse.ArgumentParser(description="Prediction files of libunisim")
    commands = parser.add_subparsers(dest="command", required=True)
    info_parser = commands.add_parser("info", help="print what a file holds and check it")
    info_parser.add_argument("file")
    options = parser.parse_args(arguments)
    try:
        info(options.file)
    except (RecordError, OSError) as error:
        print(f"{options.file}: {error}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
