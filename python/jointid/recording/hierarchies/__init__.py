"""HDF5 files and MATLAB files of version 7.3: their datasets as columns, and repeated groups."""
