"""What is identified of a robot: values, findings, verdict, tables, files."""
