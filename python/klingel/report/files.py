"""Files written whole or not at all: to a temporary name in the same folder, then renamed.
A reader never sees half a file, and an interrupted write leaves the old one."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """A temporary path to write to; it becomes `path` when the block ends well, and vanishes when it does not.

    Args:
        path: that the file shall have; its folder must exist.

    Yields:
        The temporary path, with the same suffix in the same folder.

    Raises:
        OSError: the folder is missing or not writable.

    Example:
        >>> import tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     with whole(Path(folder) / "a.txt") as temporary:
        ...         _ = temporary.write_text("whole")
        ...     [p.name for p in Path(folder).iterdir()]
        ['a.txt']
    """
    temporary = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        yield temporary
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def write_whole(path: Path, content: bytes) -> Path:
    """Write bytes to a file, whole or not at all.

    Args:
        path: of the file; its folder must exist.
        content: of the file.

    Returns:
        The path.

    Raises:
        OSError: the folder is missing or not writable.
    """
    with whole(path) as temporary:
        temporary.write_bytes(content)
    return path
