"""Frozen values behave as the dataclasses of the standard library do, whatever is asked of them."""

import copy
import dataclasses
import inspect
import pickle
import typing
from collections.abc import Callable
from dataclasses import KW_ONLY, field
from threading import Barrier, Thread
from typing import Any, ClassVar

import pytest

from jointid.base import values

Decorator = Callable[..., Callable[[type[Any]], type[Any]]]


def pair_of(decorator: Decorator, **options: bool) -> type[Any]:
    """A class with everything that a field can have."""

    class Pair:
        """Two."""

        first: int
        _: KW_ONLY
        second: str = "b"
        third: list[int] = field(default_factory=list, hash=False)
        hidden: float = field(default=0.0, repr=False, compare=False)
        common: ClassVar[int] = 3

        def __post_init__(self) -> None:
            if self.first < 0:
                raise ValueError("too small")

    return decorator(frozen=True, **options)(Pair)


def both(**options: bool) -> tuple[type[Any], type[Any]]:
    ours: Any = values.dataclass
    return pair_of(ours, **options), pair_of(dataclasses.dataclass, **options)


OPTIONS: list[dict[str, bool]] = [
    {},
    {"slots": True},
    {"slots": True, "kw_only": True},
    {"eq": False},
    {"repr": False, "slots": True},
]


@pytest.mark.parametrize("options", OPTIONS)
def test_the_arguments_are_the_same(options: dict[str, bool]) -> None:
    ours, theirs = both(**options)
    assert str(inspect.signature(ours)) == str(inspect.signature(theirs))
    assert typing.get_type_hints(ours.__init__) == typing.get_type_hints(theirs.__init__)
    assert ours.__init__.__qualname__ == theirs.__init__.__qualname__
    ours, theirs = both(**options)
    signatures = [inspect.signature(type("Plain", (each,), {})) for each in (ours, theirs)]
    assert str(signatures[0]) == str(signatures[1])  # of a subclass without fields, asked first
    ours, theirs = both(**options)  # the first call, and not the signature, compiles
    for arguments in ((), (1, "x"), (1, 2, 3, 4, 5)):
        with pytest.raises(TypeError) as error:
            ours(*arguments)
        with pytest.raises(TypeError) as expected:
            theirs(*arguments)
        assert str(error.value) == str(expected.value)
    with pytest.raises(ValueError, match="too small"):
        ours(first=-1)


CALLS: list[tuple[tuple[Any, ...], dict[str, Any]]] = [
    ((1,), {}),
    ((), {"first": 1, "third": [2]}),
    ((1,), {"second": "c", "hidden": 1.0}),
    ((), {}),
    ((), {"second": "c"}),
    ((1,), {"first": 1}),
    ((1, "c"), {}),
    ((1,), {"unknown": 1}),
    ((-1,), {}),
]


@pytest.mark.parametrize("options", OPTIONS)
def test_a_seldom_call_does_what_a_compiled_one_does(options: dict[str, bool]) -> None:
    for unnamed, named in CALLS:
        ours, theirs = both(**options)
        seldom = outcome(ours, unnamed, named)
        for _ in range(values._OFTEN + 1):
            ours(first=1)
        assert inspect.isfunction(vars(ours)["__init__"])
        assert seldom == outcome(ours, unnamed, named) == outcome(theirs, unnamed, named)


def outcome(made: type[Any], unnamed: tuple[Any, ...], named: dict[str, Any]) -> Any:
    """The values of the fields, or the error."""
    try:
        return dataclasses.asdict(made(*unnamed, **named))
    except (TypeError, ValueError) as error:
        return str(error)


def test_what_is_called_seldom_is_not_compiled() -> None:
    ours, _ = both()
    ours(first=1)
    assert not inspect.isfunction(vars(ours)["__init__"])


@pytest.mark.parametrize("options", OPTIONS)
def test_a_value_looks_and_compares_the_same(options: dict[str, bool]) -> None:
    ours, theirs = both(**options)
    one, same, other = ours(first=1), ours(first=1, hidden=2.0), ours(first=1, third=[4])
    if options.get("repr", True):
        assert repr(one) == repr(theirs(first=1))
    assert (one == same, one == other) == (
        theirs(first=1) == theirs(first=1, hidden=2.0),
        theirs(first=1) == theirs(first=1, third=[4]),
    )
    assert one.__eq__("text") is NotImplemented
    assert (hash(one) == hash(same)) == options.get("eq", True)
    assert (hash(one) == hash(other)) == options.get("eq", True)
    assert one.third is not same.third
    assert ours.__match_args__ == theirs.__match_args__
    assert str(ours.__dataclass_params__) == str(theirs.__dataclass_params__)
    assert dataclasses.asdict(one) == dataclasses.asdict(theirs(first=1))
    assert dataclasses.replace(one, second="c").second == "c"


@pytest.mark.parametrize("options", OPTIONS)
def test_nothing_of_it_changes(options: dict[str, bool]) -> None:
    ours, theirs = both(**options)
    changes: list[Callable[[Any], None]] = [
        lambda value: setattr(value, "first", 2),
        lambda value: delattr(value, "second"),
    ]
    for change in changes:
        with pytest.raises(dataclasses.FrozenInstanceError) as error:
            change(ours(first=1))
        with pytest.raises(dataclasses.FrozenInstanceError) as expected:
            change(theirs(first=1))
        assert str(error.value) == str(expected.value)
    # With slots, the standard library fails with another error here.
    with pytest.raises(dataclasses.FrozenInstanceError, match="'unknown'"):
        ours(first=1).unknown = 2
    with pytest.raises(dataclasses.FrozenInstanceError, match="'unknown'"):
        del ours(first=1).unknown


@pytest.mark.parametrize("options", OPTIONS)
def test_a_subclass_may_have_attributes_of_its_own(options: dict[str, bool]) -> None:
    class Longer(both(**options)[0]):  # type: ignore[misc]
        pass

    value = Longer(first=1)
    value.more = 2
    assert value.more == 2
    with pytest.raises(dataclasses.FrozenInstanceError):
        value.first = 2


@values.dataclass(frozen=True, slots=True)
class Stored:
    """A value that pickles can find."""

    first: int
    second: float = 1.0


@values.dataclass(frozen=True, kw_only=True)
class Open:
    """The same without slots."""

    first: int


@dataclasses.dataclass(frozen=True)
class OfAUser(Open):
    """A dataclass of the standard library that inherits from one of ours."""

    own: str = "u"


@values.dataclass(frozen=True)
class OfUs(Open):
    """One of ours that inherits."""

    own: str = "u"


class Circle:
    """It holds a value that holds it."""

    def __init__(self) -> None:
        self.value = Held(self)

    def __repr__(self) -> str:
        return f"Circle({self.value!r})"


@values.dataclass(frozen=True)
class Held:
    """A value with something in it."""

    of: Circle


@pytest.mark.parametrize("value", [Stored(1, 2.0), Open(first=3), OfUs(own="x", first=1)])
def test_copies_and_pickles_are_equal(value: object) -> None:
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        assert pickle.loads(pickle.dumps(value, protocol)) == value
    assert copy.copy(value) == copy.deepcopy(value) == value


def test_a_pickled_state_is_that_of_the_standard_library() -> None:
    state: Any = Stored(1, 2.0)
    assert state.__getstate__() == [1, 2.0]


def test_values_are_inherited() -> None:
    assert repr(OfAUser(first=1)) == "OfAUser(first=1, own='u')"
    assert repr(OfUs(first=1)) == "OfUs(first=1, own='u')"
    assert OfUs(first=1) == OfUs(first=1) != OfUs(first=2)


def test_a_circle_is_shown_once() -> None:
    assert repr(Circle().value) == "Held(of=Circle(...))"


def test_own_methods_are_kept() -> None:
    @values.dataclass(frozen=True)
    class Same:
        """Equal to everything."""

        first: int

        def __repr__(self) -> str:
            return "same"

        def __eq__(self, other: object) -> bool:
            return True

    assert repr(Same(1)) == "same"
    assert Same(1) == Same(2)
    assert hash(Same(1)) == hash((1,))


def test_a_value_without_frozen_is_the_standard_librarys() -> None:
    @values.dataclass
    class Counter:
        """It counts."""

        count: int = 0

    counter = Counter()
    counter.count += 1
    assert counter == Counter(1)


def test_threads_may_make_the_first_one_together() -> None:
    for _ in range(20):
        ours, _theirs = both(slots=True)
        barrier = Barrier(4)
        made: list[object] = []

        def make(ours: type[Any] = ours, barrier: Barrier = barrier, made: Any = made) -> None:
            barrier.wait()
            made.append(ours(first=1))

        threads = [Thread(target=make) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert len(set(made)) == 1
        assert len(made) == 4
