"""What another library says of a damaged file, short enough to stand in one sentence."""


def reason_of(error: BaseException) -> str:
    """Return an error's first sentence on one line, or its kind when it says nothing."""
    said = " ".join(str(error).split()).partition(". ")[0]
    return said[:120].rstrip(". ") or type(error).__name__
