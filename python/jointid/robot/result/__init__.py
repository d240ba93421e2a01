"""Results of a robot's identification: values, findings, verdict, tables, files."""
