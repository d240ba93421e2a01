"""A local page: load a log, set its columns and units, identify, compare, and export. The analysis runs in `worker`.

`call` holds the user's input, `worker` is the process that computes, and `guard` controls access to the page.
`page` and the modules of its steps draw the page, and `serving` runs the server.
"""
