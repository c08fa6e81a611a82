// MRPT's range-bearing EKF-SLAM on a range-bearing log, one step timed at a time.
//
//   mrpt_ekf_slam LOG [known|nn|jcbb]
//
// LOG has lines "L id x y", "P x y phi" (truth), "O dx dy dphi" (odometry), "Z id range bearing"; see peers/README.md.

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CLandmark.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>
#include <mrpt/version.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

using mrpt::obs::CObservationBearingRange;
using mrpt::poses::CPose2D;
using mrpt::poses::CPosePDFGaussian;

// The noise that the logs were made with.
constexpr double kOdometryVariance = 0.02 * 0.02, kHeadingVariance = 0.005 * 0.005;
constexpr double kRangeSigma = 0.05, kBearingSigma = 0.01;

struct Sighting { int id; double range, bearing; };
struct Step { CPose2D truth, odometry; std::vector<Sighting> sightings; };

std::vector<Step> read_log(const char* path) {
  std::ifstream file(path);
  std::vector<Step> steps;
  for (std::string line; std::getline(file, line);) {
    std::istringstream row(line);
    char kind = 0;
    double a = 0, b = 0, c = 0;
    row >> kind >> a >> b >> c;
    if (kind == 'P') steps.push_back({CPose2D(a, b, c), {}, {}});
    if (kind == 'O') steps.back().odometry = CPose2D(a, b, c);
    if (kind == 'Z') steps.back().sightings.push_back({static_cast<int>(a), b, c});
  }
  return steps;
}

void configure(mrpt::slam::CRangeBearingKFSLAM2D& filter, const std::string& association) {
  std::ostringstream ini;
  ini << "[RangeBearingKFSLAM_KalmanFilter]\nmethod=0\nverbose=0\n"
      << "[RangeBearingKFSLAM]\nforce_ignore_odometry=false\n"
      << "std_sensor_range=" << kRangeSigma << "\nstd_sensor_yaw_deg=" << kBearingSigma * 180 / M_PI << "\n"
      << "data_assoc_method=" << (association == "jcbb" ? "assocJCBB" : "assocNN") << "\n"
      << "data_assoc_metric=metricMaha\ndata_assoc_IC_metric=metricMaha\n"
      << "data_assoc_IC_chi2_thres=0.99\ndata_assoc_IC_ml_threshold=0.0\n";
  filter.loadOptions(mrpt::config::CConfigFileMemory(ini.str()));
  filter.KF_options.verbosity_level = mrpt::system::LVL_ERROR;
  filter.setVerbosityLevel(mrpt::system::LVL_ERROR);
}

mrpt::obs::CActionCollection::Ptr action(const Step& step, bool first) {
  CPosePDFGaussian increment(step.odometry);
  increment.cov.setZero();
  increment.cov(0, 0) = increment.cov(1, 1) = first ? 1e-12 : kOdometryVariance;
  increment.cov(2, 2) = first ? 1e-12 : kHeadingVariance;
  mrpt::obs::CActionRobotMovement2D movement;
  movement.poseChange = mrpt::poses::CPosePDF::Ptr(new CPosePDFGaussian(increment));
  movement.estimationMethod = mrpt::obs::CActionRobotMovement2D::emOdometry;
  auto actions = mrpt::obs::CActionCollection::Create();
  actions->insert(movement);
  return actions;
}

mrpt::obs::CSensoryFrame::Ptr frame(const Step& step, bool known) {
  auto look = CObservationBearingRange::Create();
  look->sensor_std_range = kRangeSigma;
  look->sensor_std_yaw = look->sensor_std_pitch = kBearingSigma;
  look->fieldOfView_yaw = 2 * M_PI;
  look->maxSensorDistance = 8;
  for (const auto& sighting : step.sightings) {
    CObservationBearingRange::TMeasurement measurement;
    measurement.landmarkID = known ? sighting.id : -1;
    measurement.range = sighting.range;
    measurement.yaw = sighting.bearing;
    measurement.pitch = 0;
    look->sensedData.push_back(measurement);
  }
  auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(look);
  return frame;
}

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: %s LOG [known|nn|jcbb]\n", argv[0]), 2;
  const std::string association = argc > 2 ? argv[2] : "known";
  const auto steps = read_log(argv[1]);
  if (steps.empty()) return std::fprintf(stderr, "%s: no steps\n", argv[1]), 1;

  mrpt::slam::CRangeBearingKFSLAM2D filter;
  configure(filter, association);
  std::vector<double> times;
  double squared_error = 0, nees = 0;
  for (const auto& step : steps) {
    const bool first = times.empty();
    auto actions = action(step, first);
    auto seen = frame(step, association == "known");
    const auto start = std::chrono::steady_clock::now();
    filter.processActionObservation(actions, seen);
    times.push_back(std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count());

    CPosePDFGaussian pose;
    filter.getCurrentRobotPose(pose);
    const CPose2D truth = step.truth - steps.front().truth;  // the filter starts at the origin
    const Eigen::Vector3d error(pose.mean.x() - truth.x(), pose.mean.y() - truth.y(),
                                std::remainder(pose.mean.phi() - truth.phi(), 2 * M_PI));
    squared_error += error.head<2>().squaredNorm();
    // The pose is certain in the first step.
    if (!first) nees += error.dot(pose.cov.asEigen().ldlt().solve(error));
  }

  CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> landmarks;
  std::map<unsigned, mrpt::maps::CLandmark::TLandmarkID> ids;
  mrpt::math::CVectorDouble state;
  mrpt::math::CMatrixDouble covariance;
  filter.getCurrentState(pose, landmarks, ids, state, covariance);

  std::string name = argv[1];
  name = name.substr(name.find_last_of('/') + 1);
  name = name.substr(0, name.find_last_of('.'));
  const double n = static_cast<double>(times.size());
  const double mean = std::accumulate(times.begin(), times.end(), 0.0) / n;
  const std::string job = "ekf_slam_step/" + name + (association == "known" ? "" : "/" + association);
  std::printf("bench\t%s\tMRPT\t%.0f\n", job.c_str(), mean);
  std::sort(times.begin(), times.end());
  std::printf("MRPT %d.%d.%d, %s: %zu landmarks, path RMSE %.4f m, NEES %.2f, median %.0f us, worst %.0f us\n", MRPT_VERSION >> 8,
              MRPT_VERSION >> 4 & 15, MRPT_VERSION & 15, association.c_str(), landmarks.size(), std::sqrt(squared_error / n), nees / (n - 1),
              times[times.size() / 2] / 1e3, times.back() / 1e3);
}
