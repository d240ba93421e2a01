"""Messages of robots' logs (MCAP, ROS bags): their topics, their bytes as numbers, and a table of joints."""
