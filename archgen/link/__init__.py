"""Link: merge the slices, declare the elements, resolve the references, and return the architecture."""

from __future__ import annotations

from archgen.link import composition_rules, reference_rules, slice_merging
from archgen.link.parameter_files import MISSING_PARAMETER_FILE
from archgen.link.project_linking import link_project
from archgen.link.report_chapters import MISSING_CHAPTER

RULES = (
    *slice_merging.RULES,
    *reference_rules.RULES,
    *composition_rules.RULES,
    MISSING_CHAPTER,
    MISSING_PARAMETER_FILE,
)

__all__ = ["RULES", "link_project"]
