"""Passes rewrite a project as another one, which is again a valid project: types written out, hierarchy taken away."""

from archgen.passes.pass_running import PASSES, TransformedProject, UnknownPassError, order_passes, run_passes
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.project_tree import ProjectTree

__all__ = ["PASSES", "Pass", "PassWork", "ProjectTree", "TransformedProject", "UnknownPassError", "order_passes"]
__all__ += ["run_passes"]
