#pragma once

#include "doctor/examination.h"

namespace fiimap {

// The checks in the order in which they are made. Thresholds and reasons are beside them.

/// choose_scans.cpp: depth images or clouds of one sensor or several.
/// \throws std::invalid_argument when topics that the user named cannot be used together.
void chooseScans(Examination* examination);
/// choose_camera_infos.cpp: for the depth images that were chosen.
/// \throws std::invalid_argument when one that the user named may be of several.
void chooseCameraInfos(Examination* examination);
/// choose_poses.cpp
void choosePoses(Examination* examination);

/// pose_checks.cpp: values that are no poses, in pose messages and in TF.
void checkPoseValues(Examination* examination);
/// pose_checks.cpp: map_frame.
void checkMapFrame(Examination* examination);
/// time_checks.cpp: stamps of poses that are missing, their rate, gaps.
void checkPoseRate(Examination* examination);

/// time_checks.cpp: use_sim_time and /clock.
void checkSimulatedTime(Examination* examination);

/// check_sensors.cpp: what follows up to checkTrial, for every sensor; tries all of them out.
void checkSensors(Examination* examination);
/// choose_scans.cpp: whether a message came.
void checkScansCome(Examination* examination);
/// image_checks.cpp: \return false where the images are none of depth, which is all to say of them.
bool checkEncoding(Examination* examination);
/// image_checks.cpp: whether there is a camera_info that fits.
void checkCameraInfo(Examination* examination);
/// image_checks.cpp: pixels without depth, and the unit of the others.
void checkDepthReadings(Examination* examination);
/// cloud_checks.cpp: fields, points that are not finite.
void checkCloudPoints(Examination* examination);
/// cloud_checks.cpp: clouds that were moved into the world before.
void checkCloudFrame(Examination* examination);

/// body_checks.cpp: body_frame and whether TF leads from it to the sensor.
void checkBodyFrame(Examination* examination);
/// mount_checks.cpp: where the camera looks, seen from the body.
void checkMount(Examination* examination);

/// time_checks.cpp: stamps of scans that are missing, their rate.
void checkScanRate(Examination* examination);
/// time_checks.cpp: whether scans and poses are stamped by one clock.
void checkClocks(Examination* examination);
/// trial_checks.cpp: scans that the map would drop.
void checkTrial(const Trial& trial, Examination* examination);
/// map_checks.cpp: what a mapping node that runs listens to and says.
void checkRunningMap(Examination* examination);

}  // namespace fiimap
