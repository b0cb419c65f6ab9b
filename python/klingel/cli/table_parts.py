"""Solved parts of a table of creep forces, a file each: written whole, checked when read, so that work can go on.
A file is the SHA-256 of its place and content and then the content, little-endian doubles."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from klingel.report.files import write_whole

if TYPE_CHECKING:
    from klingel._core import CreepTableMaker

Values = NDArray[np.float64]
SUM = hashlib.sha256().digest_size


@dataclass
class Parts:
    """Parts of one table, in a folder of their own; those on disk are taken over when it is made.

    maker: what solves them; folder: is made if it is missing; solved: forces of each finished part, (points, 3), over
    mu N and mu N times a length; damaged: parts whose files were not as they were written.
    Errors: OSError for a folder that cannot be made or read.
    """

    maker: CreepTableMaker
    folder: Path
    solved: dict[int, Values] = field(default_factory=dict)
    damaged: list[int] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        for part in range(self.maker.parts):
            if not self.path(part).exists():
                continue
            forces = self._read(part)
            if forces is None:
                self.damaged.append(part)
            else:
                self.solved[part] = forces

    def path(self, part: int) -> Path:
        """The file of a part."""
        return self.folder / f"{part:04d}.part"

    def missing(self) -> list[int]:
        """Parts still to be solved, in their order."""
        return [part for part in range(self.maker.parts) if part not in self.solved]

    def solve(self, part: int) -> None:
        """Solve a part, which takes all cores some seconds, and keep it. Errors: OSError; the core's own."""
        forces = self.maker.solve(part)
        content = forces.astype("<f8").tobytes()
        write_whole(self.path(part), self._sum(part, content) + content)
        self.solved[part] = forces

    def finish(self) -> bytes:
        """The table's file; only when no part is missing."""
        return self.maker.finish([self.solved[part] for part in range(self.maker.parts)])

    def _read(self, part: int) -> Values | None:
        """A part as it was written; None for a damaged file, or one of another table or part."""
        content = self.path(part).read_bytes()
        check_sum, content = content[:SUM], content[SUM:]
        if check_sum != self._sum(part, content) or len(content) != 24 * self.maker.part_len(part):
            return None
        return np.frombuffer(content, dtype="<f8").astype(np.float64).reshape(-1, 3)

    def _sum(self, part: int, content: bytes) -> bytes:
        return hashlib.sha256(f"{self.maker.key}/{part}/".encode() + content).digest()
