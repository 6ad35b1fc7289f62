"""A file in memory that holds what is written to it and nothing of the room in between."""

import io
import os
from pathlib import Path
from typing import Any


class SparseFile(io.RawIOBase):
    """For HDF5 to lay out files of any size: only what it writes itself is kept."""

    def __init__(self) -> None:
        self._pieces: list[tuple[int, bytes]] = []  # later ones lie on top
        self._place = self._end = 0

    def readable(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        start = {os.SEEK_SET: 0, os.SEEK_CUR: self._place, os.SEEK_END: self._end}[whence]
        self._place = start + offset
        return self._place

    def tell(self) -> int:
        return self._place

    def truncate(self, size: int | None = None) -> int:
        self._end = self._place if size is None else size
        return self._end

    def write(self, data: Any) -> int:
        piece = bytes(data)
        self._pieces.append((self._place, piece))
        self._place += len(piece)
        self._end = max(self._end, self._place)
        return len(piece)

    def readinto(self, buffer: Any) -> int:
        """Fill a buffer; what was never written reads as zeros."""
        out = bytearray(len(buffer))
        for start, piece in self._pieces:
            first = max(start, self._place)
            last = min(start + len(piece), self._place + len(out))
            if first < last:
                out[first - self._place : last - self._place] = piece[first - start : last - start]
        buffer[:] = out
        self._place += len(out)
        return len(out)

    def save(self, path: Path) -> None:
        """Write it to a file, with holes where nothing was written. Raises OSError."""
        with path.open("wb") as file:
            file.truncate(self._end)
            for start, piece in self._pieces:
                file.seek(start)
                file.write(piece)
