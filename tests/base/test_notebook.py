"""Every result shows itself in a notebook."""

import inspect

import jointid as jid

SHOWN = (
    "Estimate",
    "Comparison",
    "Study",
    "Design",
    "Recording",
    "Joint",
    "JointEstimates",
    "SelfTest",
)
REPORTS = (
    "RobotEstimate",
    "RobotComparison",
    "ServoEstimate",
    "ServoComparison",
    "Rollout",
    "Bootstrap",
)


def test_every_result_has_a_picture_of_itself() -> None:
    for name in (*SHOWN, *REPORTS):
        assert callable(getattr(getattr(jid, name), "_repr_html_", None)), name


def test_every_public_class_with_a_report_is_shown() -> None:
    for name in jid._HOME_OF:
        found = getattr(jid, name)
        if inspect.isclass(found) and hasattr(found, "report"):
            assert hasattr(found, "_repr_html_"), name
