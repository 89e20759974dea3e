//! Room that measurements need and that a user's board does not have: whole pictures, meshes.

/// A `&'static mut` to a value: in the region BENCH of `memory.x` on ARM, which only measured images may use; in the
/// memory of RISC-V's `virt`; boxed on a host. The value is constant; what stands there at first on ARM is zeros, whatever
/// the value is, so the caller fills it.
///
/// A board may run each expansion once.
macro_rules! room {
    ($type:ty, $value:expr) => {{
        #[cfg(target_os = "none")]
        {
            #[cfg_attr(target_arch = "arm", unsafe(link_section = ".bench"))]
            static mut ROOM: $type = $value;
            // SAFETY: the static has no other name, and reports run once.
            unsafe { &mut *(&raw mut ROOM) }
        }
        #[cfg(not(target_os = "none"))]
        {
            Box::leak(Box::<$type>::new($value))
        }
    }};
}

pub(crate) use room;
