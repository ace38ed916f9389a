"""Link: merge the slices, declare the elements, resolve the references, and return the architecture."""

from __future__ import annotations

from archgen.link import linking_rules, slice_merging
from archgen.link.declare.frame_declaration import DUPLICATE_FRAME
from archgen.link.hint_checks import WRONG_HINT
from archgen.link.known_programs import SHADOWED_PACKAGE, UNLIKE_PROGRAM
from archgen.link.named_files import MISSING_FILE
from archgen.link.node_parameter_files import MISSING_PARAMETER_FILE
from archgen.link.project_linking import link_project
from archgen.link.report_chapters import MISSING_CHAPTER, MISSING_PICTURE
from archgen.link.verification_files import MISSING_VERIFICATION

RULES = (
    *slice_merging.RULES,
    *linking_rules.RULES,
    DUPLICATE_FRAME,
    MISSING_CHAPTER,
    MISSING_PICTURE,
    MISSING_FILE,
    MISSING_PARAMETER_FILE,
    MISSING_VERIFICATION,
    WRONG_HINT,
    SHADOWED_PACKAGE,
    UNLIKE_PROGRAM,
)

__all__ = ["RULES", "link_project"]
