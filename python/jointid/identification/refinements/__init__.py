"""Corrections of the data before the search: delays, the sensor's sampling instant, and a minimum speed."""
