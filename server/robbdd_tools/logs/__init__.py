"""Read recordings of real robots: ROS bags, MCAP files and tables. No other package uses rosbags."""
