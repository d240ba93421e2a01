"""Values that do not belong where they stand, as JSON and as TOML write them."""

import json

SCRIPT = "<script>alert(1)</script>"
DEEP = "[" * 100_000 + "]" * 100_000
REMOVED = ""
"""Instead of a value: its key is left out."""

_BOTH = (
    *("true", "-1", "0", "0.5", "1e308", "-1e308", "5e-324", "9223372036854775808", "1" * 400),
    *('""', json.dumps(SCRIPT), '"nan"', '"../../x"', '"\\n\\u0007"', json.dumps("x" * 20_000)),
    *("[]", "[[]]", '["a", 1.0]', "[" * 30 + "]" * 30, DEEP, "{}", REMOVED),
)
JSON = (*_BOTH, "null", "1e400", "-1e400", "NaN", '"\\ud800"', "1" * 5000, '{"a": {"a": [null]}}')
# TOML has no null; 1e400 is its inf, and a date is a type that JSON does not have.
TOML = (*_BOTH, "inf", "nan", "1e400", "1979-05-27", "1" * 5000, "{a = {a = [nan]}}")
