//! EKF-SLAM with honest uncertainty: landmarks, association, anchors.
