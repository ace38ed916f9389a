"""Links in the project's own output folder that lead out of the project."""

from __future__ import annotations

import os
from pathlib import Path

from archgen.emit import file_tree
from archgen.pipeline import CheckedProject


def refuse_leaving_links(checked_project: CheckedProject, target: Path) -> None:
    """Refuse a place in the project's own output folder that a link leads out of the project.

    A stranger's branch can hold a link called `archgen-out`. A folder that somebody names with `-o` is where he wants it.
    """
    own_folder = Path(os.path.normpath(checked_project.output_folder.absolute()))
    # The last name as well, where it is a link: what is written would go through it.
    leads_out = not Path(os.path.realpath(target)).is_relative_to(os.path.realpath(checked_project.root))
    if leads_out and Path(os.path.normpath(target.absolute())).is_relative_to(own_folder):
        msg = f"{target} is reached by a link that leads out of the project"
        raise file_tree.OutputError(msg, "take the link away, or name the folder with `-o`")
