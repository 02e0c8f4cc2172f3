//! Objects that were made before: equal arguments give the same object, in every thread.

use super::call::{Call, Object, SlotKind};
use rustc_hash::FxHashMap;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// Most objects that are remembered; more are made by models whose parameters change.
const MAX_OBJECTS: usize = 256;

/// What an object was made from: the name of the function, numbers, strings.
#[derive(PartialEq, Eq, Hash)]
struct Key {
    name: &'static str,
    numbers: Vec<u64>,
    strings: Vec<Arc<str>>,
}

/// Objects of a model; clones remember together.
#[derive(Clone, Default)]
pub struct Objects(Arc<Mutex<FxHashMap<Key, Object>>>);

impl fmt::Debug for Objects {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Objects").finish_non_exhaustive()
    }
}

impl Objects {
    /// Makes the object that a call requests with `make`, unless it is known. Files count as
    /// unchanged.
    pub fn remember<E>(
        &self,
        call: &mut Call<'_>,
        make: impl FnOnce(&mut Call<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let key = Key::of(call);
        let known = self.lock().get(&key).cloned();
        if let Some(object) = known {
            call.give_shared(object);
            return Ok(());
        }
        make(call)?;
        if let Some(object) = call.objects.last() {
            let mut objects = self.lock();
            if objects.len() >= MAX_OBJECTS {
                objects.clear();
            }
            objects.insert(key, object.clone());
        }
        Ok(())
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, FxHashMap<Key, Object>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Key {
    fn of(call: &Call<'_>) -> Key {
        let mut key = Key { name: call.name, numbers: Vec::new(), strings: Vec::new() };
        for slot in call.arguments {
            let first = slot.first as usize;
            key.numbers.extend(slot.dims.iter().map(|size| u64::from(*size)));
            match slot.kind {
                SlotKind::Text => {
                    key.strings.extend_from_slice(&call.strings[first..][..slot.len()])
                }
                SlotKind::Number | SlotKind::Numbered | SlotKind::Object => {
                    let numbers = &call.numbers[first..][..slot.len()];
                    key.numbers.extend(numbers.iter().map(|number| number.to_bits()));
                }
            }
        }
        key
    }
}
