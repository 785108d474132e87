//! A log in the browser: a local page with a player, plots that follow it, and a second log beside it in step.
//!
//! [`Server`] listens on the loopback device alone and gives [`Site::respond`] the head of every request; that is a function
//! from bytes to a [`Response`], which knows four addresses and touches no file but the logs that were opened.
//! [`export`] writes the same page with frames in it, for those who have no server.

mod clusters;
mod colouring;
mod density;
mod error;
mod export;
mod log;
mod packing;
mod page;
mod request;
mod response;
mod server;
mod site;

pub use error::ViewError;
pub use export::{Exported, export};
pub use log::ViewedLog;
pub use response::Response;
pub use server::{Limits, Server, wake};
pub use site::Site;
