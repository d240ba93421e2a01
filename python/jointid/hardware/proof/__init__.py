"""A bench proven before it is trusted: check, first motion, certificate."""
