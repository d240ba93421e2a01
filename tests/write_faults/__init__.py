"""Writing that fails at any call: a library before the C library's, and what is written through it."""
