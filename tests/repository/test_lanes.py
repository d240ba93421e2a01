"""What the quick lane says of slow tests."""

from pathlib import Path

import lanes
import pytest

pytest_plugins = ["pytester"]

CONFTEST = """
import lanes

class Clock:
    seconds = 0.0
    def __call__(self):
        return self.seconds
    def advance(self, seconds):
        self.seconds += seconds

clock = Clock()

def pytest_configure(config):
    config.addinivalue_line("markers", "slow: long")
    config.pluginmanager.register(lanes.Lane(clock))
"""


def run(pytester: pytest.Pytester, text: str, *options: str) -> pytest.RunResult:
    pytester.makeconftest(CONFTEST)
    pytester.makepyfile("import pytest\nfrom conftest import clock\n" + text)
    pytester.syspathinsert(Path(lanes.__file__).parent)
    return pytester.runpytest_inprocess("-p", "no:cacheprovider", *options)


def test_an_unmarked_test_that_is_slow_is_an_error(pytester: pytest.Pytester) -> None:
    outcome = run(
        pytester,
        """
def test_quick():
    clock.advance(2.0)
def test_longer():
    clock.advance(2.5)
def test_too_long():
    clock.advance(6.5)
def test_last():
    pass
""",
    )
    outcome.assert_outcomes(passed=4, errors=1)
    assert outcome.ret == pytest.ExitCode.TESTS_FAILED
    outcome.stdout.fnmatch_lines(
        [
            "*test_too_long took 6.5 s of CPU*mark it slow, and keep a quick test of the same promise",
            "*more than 2 s of CPU*",
            "   6.5 s  *test_too_long",
            "   2.5 s  *test_longer",
        ]
    )
    outcome.stdout.no_fnmatch_line("* s  *test_quick")


def test_setup_and_teardown_are_the_tests(pytester: pytest.Pytester) -> None:
    outcome = run(
        pytester,
        """
@pytest.fixture
def costly():
    clock.advance(3.0)
    yield
    clock.advance(2.0)
def test_both(costly):
    clock.advance(1.5)
def test_last():
    pass
""",
    )
    outcome.assert_outcomes(passed=2, errors=1)
    outcome.stdout.fnmatch_lines(["   6.5 s  *test_both"])


@pytest.mark.parametrize("options", [(), ("--numprocesses", "1")], ids=["here", "xdist"])
def test_a_shared_fixture_is_no_tests(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, options: tuple[str, ...]
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(lanes.__file__).parent))
    outcome = run(
        pytester,
        """
@pytest.fixture(scope="session")
def wide():
    clock.advance(30.0)
@pytest.fixture(scope="module")
def shared(request):
    request.getfixturevalue("wide")
    clock.advance(10.0)
    yield
    clock.advance(20.0)
def test_first(shared):
    clock.advance(1.0)
def test_last(shared):
    clock.advance(1.0)
""",
        *options,
    )
    outcome.assert_outcomes(passed=2)
    outcome.stdout.fnmatch_lines(
        ["  40.0 s  *test_first (fixture shared)", "  20.0 s  *test_last (shared teardown)"]
    )


def test_the_quick_lane_alone_measures(request: pytest.FixtureRequest) -> None:
    plugins = request.config.pluginmanager.get_plugins()
    measured = request.config.getoption("markexpr") == lanes.QUICK
    assert any(isinstance(each, lanes.Lane) for each in plugins) == measured
