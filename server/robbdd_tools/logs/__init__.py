"""Read recordings of real robots: ROS bags, MCAP files and tables. The only user of rosbags."""
