//! Linear estimation: factorised Kalman filters, smoothers, Riccati equation, moving horizon. No thermal words here.
