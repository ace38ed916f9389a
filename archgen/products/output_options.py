"""What users may choose about outputs: a part, a level of detail, the printed revision, and the place, within limits."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.emit.file_tree import OutputError
from archgen.frozen import dataclass

if TYPE_CHECKING:
    from archgen.checking.checked_project import CheckedProject
    from archgen.model.selector_evaluation import Selection
    from archgen.products.trusted_backends import TrustedRevision
    from archgen.views.changes.site_changes import SiteChanges
    from archgen.views.pages.report_outline import DetailLevel, ReportDocument

DrawingProgress = Callable[[int, int], None]
"""Called with the number of pictures drawn so far, and of all pictures."""


@dataclass(frozen=True, slots=True)
class OutputOptions:
    """What to show and how to print it: a selection, a level of detail, a revision.

    `selector_text` is the selector as the user wrote it. `progress` is called during long work, `warn` for what an
    output could not contain as asked for.
    """

    selection: Selection | None = None
    selector_text: str = ""
    level: DetailLevel | None = None
    revision: str | None = None
    progress: DrawingProgress | None = None
    warn: Callable[[str], None] = lambda _text: None
    show_history: bool = True
    """Whether documents show how the project grew; only possible where git can tell."""
    trusted_revision: TrustedRevision | None = None
    """Decides which backends of the project itself may run; None allows all of them."""
    component_pictures: bool | None = None
    """Whether the site has a picture of each component and group; None: as `drawing_set.list_undrawn_kinds` says."""
    depth: int = 0
    """How many levels of composed components pictures open."""
    types_only: bool = False
    """Whether only the component types are asked for: `--select type:` of an export that has them."""
    changes: SiteChanges | None = None
    """What changed since an earlier version, where site and report are to show it."""
    document: ReportDocument = "deliverable"
    """Which of the report's documents is written."""


def refuse_leaving_links(checked_project: CheckedProject, target: Path) -> None:
    """Refuse a place in the project's own output folder that a link leads out of the project.

    A stranger's branch can hold a link called `archgen-out`. A folder that somebody names with `-o` is where he wants it.
    """
    own_folder = Path(os.path.normpath(checked_project.output_folder.absolute()))
    # The last name as well, where it is a link: what is written would go through it.
    leads_out = not Path(os.path.realpath(target)).is_relative_to(os.path.realpath(checked_project.root))
    if leads_out and Path(os.path.normpath(target.absolute())).is_relative_to(own_folder):
        msg = f"{target} is reached by a link that leads out of the project"
        raise OutputError(msg, "take the link away, or name the folder with `-o`")
