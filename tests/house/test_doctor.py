"""The check for a stale extension, and what the doctor says about an installation that is not in order."""

import sys
import warnings
from pathlib import Path

import pytest

from klingel import doctor
from klingel.errors import CoreMissingError, StaleExtensionWarning


def test_the_hash_follows_the_sources_only(tmp_path: Path) -> None:
    crate = tmp_path / "crates" / "one"
    crate.mkdir(parents=True)
    for name in ("Cargo.toml", "Cargo.lock", "crates/one/lib.rs", "crates/one/README.md"):
        (tmp_path / name).write_text(name)
    before = doctor.source_hash(tmp_path)
    (crate / "README.md").write_text("other")
    assert doctor.source_hash(tmp_path) == before
    (crate / "lib.rs").write_text("other")
    assert doctor.source_hash(tmp_path) != before


def test_other_sources_warn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "source_hash", lambda _: "other")
    with pytest.warns(StaleExtensionWarning, match="make build"):
        doctor.warn_if_stale()
    sources = [finding for finding in doctor.examine() if finding.what == "sources"]
    assert [finding.good for finding in sources] == [False]


def test_same_sources_and_installed_packages_do_not_warn(monkeypatch: pytest.MonkeyPatch) -> None:
    built = doctor.core().build_info()["source_hash"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        monkeypatch.setattr(doctor, "source_hash", lambda _: built)
        doctor.warn_if_stale()
        monkeypatch.setattr(doctor, "checkout", lambda: None)
        doctor.warn_if_stale()


def test_a_missing_core_says_how_to_build_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "klingel._core", None)
    with pytest.raises(CoreMissingError, match="make build"):
        doctor.core()
    assert [f.good for f in doctor.examine() if f.what == "core"] == [False]
