//! Functions of both versions that differ in their names alone.

/// Functions without arguments.
macro_rules! plain {
    ($($name:ident = $run:expr;)*) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $name(instance: *mut c_void) -> c_int {
                let run: fn(&mut Handle) -> Result<(), Wrong> = $run;
                call(instance, stringify!($name), run)
            }
        )*
    };
}

/// Functions that fill an array.
macro_rules! filled {
    ($($name:ident = $method:ident;)*) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $name(instance: *mut c_void, values: *mut f64, n: usize) -> c_int {
                call(instance, stringify!($name), |handle| {
                    handle.instance.$method(slice_mut(values, n)?)
                })
            }
        )*
    };
}

/// Functions that keep, restore and serialize states.
macro_rules! states {
    ($keep:ident, $restore:ident, $free:ident, $size:ident, $write:ident, $read:ident) => {
        #[unsafe(no_mangle)]
        extern "C" fn $keep(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
            call(instance, stringify!($keep), |handle| keep_state(handle, state))
        }

        #[unsafe(no_mangle)]
        extern "C" fn $restore(instance: *mut c_void, state: *mut c_void) -> c_int {
            call(instance, stringify!($restore), |handle| restore_state(handle, state))
        }

        #[unsafe(no_mangle)]
        extern "C" fn $free(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
            call(instance, stringify!($free), |_| free_state(state))
        }

        #[unsafe(no_mangle)]
        extern "C" fn $size(instance: *mut c_void, state: *mut c_void, size: *mut usize) -> c_int {
            call(instance, stringify!($size), |handle| state_size(handle, state, size))
        }

        #[unsafe(no_mangle)]
        extern "C" fn $write(
            instance: *mut c_void,
            state: *mut c_void,
            bytes: *mut u8,
            size: usize,
        ) -> c_int {
            call(instance, stringify!($write), |handle| write_state(handle, state, (bytes, size)))
        }

        #[unsafe(no_mangle)]
        extern "C" fn $read(
            instance: *mut c_void,
            bytes: *const u8,
            size: usize,
            state: *mut *mut c_void,
        ) -> c_int {
            call(instance, stringify!($read), |handle| read_state(handle, (bytes, size), state))
        }
    };
}

pub(crate) use {filled, plain, states};
