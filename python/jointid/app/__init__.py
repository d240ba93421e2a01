"""A local page: drop a log, fix its columns and units, identify, compare, and export. No analysis is made here.

`call` is what the page's user has stated so far, `looking` what a file holds before it is read, `worker` the process
that computes, `guard` who may talk to the page, `page` and its siblings what is shown, `serving` the program.
"""
