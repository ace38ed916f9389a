"""Work out comprehensions in launch files in Python over what is known."""

from __future__ import annotations

import ast

from archgen.plugins.ros.launch.launch_values import LaunchValue
from archgen.plugins.ros.launch.python_expressions import ExpressionReader, list_loop_items
from archgen.plugins.ros.launch.python_operators import MAX_ITEMS
from archgen.plugins.ros.launch.python_values import NameScope


class ComprehensionReader(ExpressionReader):
    """Reads comprehensions, besides all other expressions."""

    def __init__(self, file: str, lines: list[str]) -> None:
        super().__init__(file, lines)
        self._expression_readers |= {
            ast.ListComp: self._read_list_comprehension,
            ast.GeneratorExp: self._read_generator,
            ast.DictComp: self._read_dict_comprehension,
        }

    def _read_list_comprehension(self, node: ast.ListComp, scope: NameScope) -> LaunchValue:
        scopes = self._walk_generators(node.generators, NameScope(scope), 0)
        return self.quote(node) if scopes is None else [self.evaluate(node.elt, each) for each in scopes]

    def _read_generator(self, node: ast.GeneratorExp, scope: NameScope) -> LaunchValue:
        scopes = self._walk_generators(node.generators, NameScope(scope), 0)
        return self.quote(node) if scopes is None else [self.evaluate(node.elt, each) for each in scopes]

    def _read_dict_comprehension(self, node: ast.DictComp, scope: NameScope) -> LaunchValue:
        scopes = self._walk_generators(node.generators, NameScope(scope), 0)
        if scopes is None:
            return self.quote(node)
        pairs = [(self.evaluate(node.key, each), self.evaluate(node.value, each)) for each in scopes]
        return dict(pairs) if all(isinstance(key, str | int) for key, _ in pairs) else self.quote(node)

    def _walk_generators(
        self, generators: list[ast.comprehension], scope: NameScope, depth: int
    ) -> list[NameScope] | None:
        """Return a scope for each round of a comprehension; None where that is not known."""
        if depth == len(generators):
            return [scope]
        generator = generators[depth]
        items = list_loop_items(self.evaluate(generator.iter, scope))
        if items is None:
            return None
        found: list[NameScope] = []
        for item in items:
            inner = NameScope(scope)
            self.assign(generator.target, item, inner)
            verdicts = [self.judge(self.evaluate(test, inner)) for test in generator.ifs]
            if None in verdicts:
                return None
            if all(verdicts):
                inner_scopes = self._walk_generators(generators, inner, depth + 1)
                if inner_scopes is None or len(found) + len(inner_scopes) > MAX_ITEMS or not self.count_step():
                    return None
                found += inner_scopes
        return found
