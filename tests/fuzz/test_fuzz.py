"""Randomly damaged files: nothing but an InputError, whichever reader. `make fuzz` tries a million of each."""

import gzip
import os
import random
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

import jointid as jid
from fuzz.damage import damaged
from fuzz.seeds import readers, seed_of

_CASES = int(os.environ.get("JOINTID_FUZZ") or (5_000 if os.environ.get("CI") else 300))
_START = int(os.environ.get("JOINTID_FUZZ_SEED") or 0)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", tuple(readers()))
def test_damage_is_one_sentence_or_harmless(name: str) -> None:
    """The number of a case is its seed: it can be made again alone."""
    file, content, beside, use = seed_of(name)
    inside = gzip.decompress(content) if file.endswith(".gz") else b""
    memory = Path("/dev/shm")
    wrong = []
    with TemporaryDirectory(dir=memory if memory.is_dir() else None) as folder:
        path = Path(folder) / file
        for other, known in beside.items():
            path.with_name(other).write_bytes(known)
        path.write_bytes(content)
        use(path)  # the seed is valid
        for case in range(_START, _START + _CASES):
            chance = random.Random(f"{name} {case}")
            packed = bool(inside) and case % 2 == 0  # half of them with a right checksum
            changed = damaged(inside if packed else content, chance)
            path.write_bytes(gzip.compress(changed, 1) if packed else changed)
            try:
                use(path)
            except jid.InputError as error:
                if "\n" in str(error) or len(str(error)) > 10_000:
                    wrong.append(f"case {case}: {error}")
            except Exception as error:
                wrong.append(f"case {case}: {type(error).__name__}: {error}")
    assert not wrong, f"{len(wrong)} of {_CASES}\n" + "\n".join(wrong[:10])
