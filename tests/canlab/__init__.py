"""Sessions on the kernel's own CAN: two processes on a vcan in User Mode Linux, with faults.

Outside, `machine` boots the guest and the tests judge what came out of it; inside, `inside` plays the scenarios of
`scenarios` and `kills` on a `stage` each. No clock of the wall decides: times are the emulated drive's own stamps.
"""
