"""Detections of any message type to semantic_mht_slam/SemanticObjectArray, and a map to any message type.

What a message holds where is a YAML file (`mapping`); the message type itself comes from the definition that every ROS
connection and every bag carries (`message_types`), so that the package of a detector need not be installed. `conversion`
turns one message into objects, `map_export` a map into one message; `relay_node` and `relay_bag` do it live and for bags.
"""
