"""What a project generates: the folder of its workspace, and the backends that write it."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.frozen import dataclass, field


@dataclass(frozen=True, slots=True)
class GenerateSettings:
    """The section `generate`. `into` is relative to the project's folder; of each backend its options, as texts."""

    into: str | None = None
    backends: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
