"""Every stage in order: whoever reads this first has seen the whole way from YAML files to documents.

project -> syntax -> schema -> link -> model -> transform -> analyses -> views -> emit -> files
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Literal

from archgen import analyses, link, project, schema, syntax, transform
from archgen.diagnostic import Diagnostic, Rule, settle
from archgen.findings import suppress
from archgen.link import interfaces, merge
from archgen.model import selector
from archgen.model.architecture import Architecture
from archgen.project import Loaded
from archgen.source import Sources
from archgen.syntax.tree import Table

ALL_RULES: tuple[Rule, ...] = (
    *syntax.RULES,
    *schema.RULES,
    *project.RULES,
    *link.RULES,
    *analyses.RULES,
    *suppress.RULES,
)
"""Every rule there is, in the order in which the stages run."""
