"""What docs/theory/creep_table.md says about the laws is what the cases measure."""

from pathlib import Path

from validation.creep_laws.summary import summary

PAGE = Path(__file__).parents[2] / "docs" / "theory" / "creep_table.md"


def test_page_has_the_errors_of_the_laws() -> None:
    assert summary() in PAGE.read_text(encoding="utf-8"), f"put this into {PAGE.name}:\n{summary()}"
