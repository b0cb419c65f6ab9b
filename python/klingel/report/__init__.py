"""Reports: results as one self-contained HTML page, readable offline and on paper.
The pages are made from tables and figures; nothing is computed here that is not shown."""

from __future__ import annotations

import sys
from types import ModuleType

from klingel.assess import Assessment
from klingel.report.page import Report, StudyPage, report, study_report

__all__ = ["Report", "StudyPage", "report", "study_report"]


class _CallableModule(ModuleType):
    """`klingel.report(assessment)` is the verb of the Python face, and `klingel.report` also holds its parts."""

    def __call__(self, *assessments: Assessment, title: str = "Curving assessment") -> Report:
        return report(*assessments, title=title)


sys.modules[__name__].__class__ = _CallableModule
