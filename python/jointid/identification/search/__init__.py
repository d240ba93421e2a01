"""Search domains and the searches in them."""
