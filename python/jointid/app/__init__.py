"""A local page: drop a log, fix its columns and units, identify, compare, and export. No analysis is made here.

`call` holds the user's input, `worker` is the process that computes, `guard` decides who may talk to the page, `page`
and its siblings show the steps, and `serving` runs the server.
"""
