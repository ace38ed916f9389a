"""The start-up of a project: one plan of steps, worked out from phases, connections and what nodes say. Nothing is run."""

from __future__ import annotations
