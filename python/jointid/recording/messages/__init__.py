"""Messages in robots' logs (MCAP, ROS bags): topics, decoding to numbers, and a table of joints."""
