"""What the site's explorer knows: elements, flows, what selectors look at, and where each box has its place."""

from __future__ import annotations

from archgen.views.explorer.explorer_map import make_explorer_map

__all__ = ["make_explorer_map"]
