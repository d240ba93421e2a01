"""Several joints in one table: the joint of each column, reading one joint, and reading all joints."""
