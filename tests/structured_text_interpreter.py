"""Runs function blocks of Structured Text from the tree that blark, a parser of it, makes of them.

Only what an exported joint uses is known; anything else raises, so that nothing is passed over.
"""

import math
from typing import Any

import blark.parse
from blark import transform as tree

FUNCTIONS: dict[str, Any] = {
    "ABS": abs,
    "EXP": math.exp,
    "LN": math.log,
    "SIN": math.sin,
    "COS": math.cos,
}
OPERATORS: dict[str, Any] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    ">": lambda a, b: a > b,
    "<": lambda a, b: a < b,
}


def function_blocks(text: str) -> dict[str, tree.FunctionBlock]:
    """The function blocks of a source text, by name."""
    parsed = blark.parse.parse_source_code(text).transform()
    return {str(item.name): item for item in parsed.items if isinstance(item, tree.FunctionBlock)}


class Instance:
    """A function block with its variables; names are the same in small and capital letters."""

    def __init__(self, name: str, blocks: dict[str, tree.FunctionBlock]) -> None:
        self.block = blocks[name]
        self.variables: dict[str, Any] = {}
        self.constants: set[str] = set()
        for section in self.block.declarations:
            constant = getattr(section, "attrs", None) is not None
            for item in section.items:
                for declared in item.variables:
                    variable = str(getattr(declared, "variable", declared).name).upper()
                    assert variable not in self.variables, f"{variable} is declared twice"
                    self.variables[variable] = self._initial(item.init, blocks)
                    self.constants |= {variable} if constant else set()

    def _initial(self, init: Any, blocks: dict[str, tree.FunctionBlock]) -> Any:
        if isinstance(init, tree.ArrayTypeInitialization):
            values = _flat(init.value)
            (bounds,) = init.spec.subranges
            assert int(bounds.start.value) == 0
            assert int(bounds.stop.value) + 1 == len(values)
            return [self._value(each) for each in values]
        kind = str(init.spec.type)
        if kind in blocks:
            return Instance(kind, blocks)
        assert kind in ("LREAL", "INT"), kind
        return 0 if init.value is None else self._value(init.value)

    def __getitem__(self, name: str) -> Any:
        return self.variables[name.upper()]

    def __call__(self, **inputs: float) -> None:
        for name, value in inputs.items():
            self._set(name, value)
        self._run(self.block.body)

    def _set(self, name: str, value: Any) -> None:
        assert name.upper() in self.variables, name
        assert name.upper() not in self.constants, name
        self.variables[name.upper()] = value

    def _run(self, statements: Any) -> None:
        for each in statements.statements if statements is not None else ():
            self._step(each)

    def _step(self, statement: Any) -> None:
        if isinstance(statement, tree.AssignmentStatement):
            (variable,) = statement.variables
            self._set(str(variable.name), self._value(statement.expression))
        elif isinstance(statement, tree.IfStatement):
            clauses = [
                (statement.if_expression, statement.statements),
                *((each.if_expression, each.statements) for each in statement.else_ifs),
            ]
            for condition, inner in clauses:
                if self._value(condition):
                    self._run(inner)
                    return
            if statement.else_clause is not None:
                self._run(statement.else_clause.statements)
        elif isinstance(statement, tree.ForStatement):
            assert statement.step is None
            for number in range(self._value(statement.from_), self._value(statement.to) + 1):
                self._set(str(statement.control.name), number)
                self._run(statement.statements)
        elif isinstance(statement, tree.FunctionCallStatement):
            inputs = {str(each.name.name): self._value(each.value) for each in statement.parameters}
            self[str(statement.name.name)](**inputs)
        else:
            raise NotImplementedError(type(statement).__name__)

    def _value(self, expression: Any) -> Any:
        if isinstance(expression, tree.Real):
            return float(expression.value)
        if isinstance(expression, tree.Integer):
            return int(expression.value)
        if isinstance(expression, tree.ParenthesizedExpression):
            return self._value(expression.expr)
        if isinstance(expression, tree.UnaryOperation):
            assert str(expression.op) == "-"
            return -self._value(expression.expr)
        if isinstance(expression, tree.BinaryOperation):
            left, right = self._value(expression.left), self._value(expression.right)
            return OPERATORS[str(expression.op)](left, right)
        if isinstance(expression, tree.FunctionCall):
            (argument,) = expression.parameters
            return FUNCTIONS[str(expression.name.name)](self._value(argument.value))
        if isinstance(expression, tree.MultiElementVariable):
            (element,) = expression.elements
            whole = self[str(expression.name.name)]
            if isinstance(element, tree.FieldSelector):
                return whole[str(element.field.name)]
            (index,) = element.subscripts
            place = self._value(index)
            assert 0 <= place < len(whole)
            return whole[place]
        if isinstance(expression, tree.SimpleVariable):
            return self[str(expression.name)]
        raise NotImplementedError(type(expression).__name__)


def _flat(value: Any) -> list[Any]:
    """An array's values: blark nests what stands in one row."""
    if isinstance(value, tree.ArrayInitialization):
        return [each for element in value.elements for each in _flat(element)]
    if isinstance(value, tree.ArrayInitialElement):
        assert value.count is None
        return _flat(value.element)
    return [value]
