"""What this installation is made of, and whether it fits together: extension, checkout, packages, library.
Light on imports: the check for a stale extension runs whenever klingel is imported in a checkout."""

from __future__ import annotations

import hashlib
import platform
import sys
import warnings
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

from klingel.core import core
from klingel.errors import CoreMissingError, InputError, StaleExtensionWarning

PACKAGES = ("numpy", "scipy", "pydantic", "pint", "xarray", "netCDF4", "pandas", "matplotlib", "typer", "rich")


@dataclass(frozen=True)
class Finding:
    """One line of the report: what was looked at, what was found, whether that is as it should be."""

    what: str
    found: str
    good: bool = True


def checkout() -> Path | None:
    """Root of the checkout that this package is imported from, None for an installed package."""
    root = Path(__file__).resolve().parents[2]
    return root if (root / "crates").is_dir() and (root / "Cargo.lock").is_file() else None


def source_hash(root: Path) -> str:
    """SHA-256 over the sources that the extension is built from, as `crates/python/build.rs` takes it."""
    files = [root / "Cargo.toml", root / "Cargo.lock"]
    files += [f for f in (root / "crates").rglob("*") if f.suffix in (".rs", ".toml") and f.is_file()]
    digest = hashlib.sha256()
    for name, file in sorted((f.relative_to(root).as_posix(), f) for f in files):
        digest.update(name.encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


def warn_if_stale() -> None:
    """Warn if the extension was built from other sources than those of the checkout."""
    root = checkout()
    if root is None:
        return
    try:
        built = core().build_info()["source_hash"]
    except CoreMissingError:
        return  # the first use of the core says so, with the remedy
    if built != source_hash(root):
        message = "the compiled core is older than the sources of this checkout; run `make build`"
        warnings.warn(message, StaleExtensionWarning, stacklevel=3)


def examine() -> list[Finding]:
    """Look at everything; every finding says whether it is as it should be."""
    return [
        Finding("python", f"{platform.python_version()} on {platform.machine()}", sys.version_info >= (3, 11)),
        *_core_findings(),
        *(_package(name) for name in PACKAGES),
        *_library_findings(),
    ]


def _core_findings() -> list[Finding]:
    try:
        info = core().build_info()
    except CoreMissingError as error:
        return [Finding("core", str(error), False)]
    version = metadata.version("klingel")
    findings = [
        Finding("core", f"{info['version']}, {info['profile']} build", info["version"] == version),
        Finding(
            "optimised", "yes" if info["profile"] == "release" else "no: run `make build`", info["profile"] == "release"
        ),
        Finding("CPU features", ", ".join(info["cpu_features"]) or "baseline"),
    ]
    root = checkout()
    findings += [_cache(), _creep_table(root)]
    if root is None:
        return [*findings, Finding("sources", f"installed, built from {info['source_hash'][:12]}")]
    fresh = source_hash(root) == info["source_hash"]
    return [*findings, Finding("sources", "as in the checkout" if fresh else "changed since: run `make build`", fresh)]


def _cache() -> Finding:
    """The contact tables on disk; a damaged one is harmless, the next run replaces it."""
    found = core().cache()
    if found is None:
        return Finding("cache", "off: contact tables are compiled by every process")
    folder, tables = found
    damaged = [name for name, _, whole in tables if not whole]
    size = sum(size for _, size, _ in tables) / 1e6
    text = f"{folder}: {len(tables)} contact tables, {size:.0f} MB, check sums "
    return Finding("cache", text + (f"wrong in {', '.join(damaged)}: remove it" if damaged else "right"), not damaged)


def _creep_table(root: Path | None) -> Finding:
    """The table of creep forces in the core, and whether it is that of the checkout."""
    from klingel.contact.table import creep_table, header

    try:
        table = creep_table()
    except core().CoreError as error:
        return Finding("creep table", str(error), False)
    text = f"{table}, SHA-256 {table.check_sum[:12]} right"
    if root is None:
        return Finding("creep table", text)
    file = root / "crates" / "physics" / "data" / "creep_table.bin"
    same = header(file.read_bytes()).get("checksum") == table.check_sum
    return Finding("creep table", text if same else f"{text}, but {file.name} is another: run `make build`", same)


def _package(name: str) -> Finding:
    try:
        return Finding(name, metadata.version(name))
    except metadata.PackageNotFoundError:
        return Finding(name, "missing: run `make build`", False)


def _library_findings() -> list[Finding]:
    from klingel import library

    return [_library_file(name) for name in library.names()]


def _library_file(name: str) -> Finding:
    from klingel import library

    try:
        library.vehicle(name)
    except InputError as error:
        return Finding(f"library/{name}", str(error), False)
    return Finding(f"library/{name}", library.check_sum(name))
