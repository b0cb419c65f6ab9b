"""Every validation case reaches every figure that was asked of it; the long ones only under `make validate`."""

import pytest
from validation.page import CASES, case, table

SHORT = [name for name in CASES if not getattr(case(name), "LONG", False)]


@pytest.mark.parametrize("name", SHORT)
def test_case_reaches_its_figures(name: str) -> None:
    missed = [row for row in case(name).run() if not row.passed]
    assert not missed, table(missed)
